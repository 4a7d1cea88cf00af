// Keeps a search direction d from moving a vertex through the tangent plane of its nearest body surface.
//     g = n . x - offset > 0:   if n . d < -p g, then the normal part of d becomes -p g n
// An iteration may close only the fraction p of the gap, so the vertex feels the barrier before it reaches the surface.
// Source: the step limit of incremental potential contact (Li and others 2020), here per vertex and for planes.
#pragma once
#include "../portable.h"

// The fraction p of its gap that a vertex may close in one iteration [1]. Chosen by hand; not measured.
#define LIMIT_STEP_PART REAL(0.9)

typedef struct {
    GLOBAL const real* RESTRICT pos;
    GLOBAL const real* RESTRICT normal;
    GLOBAL const real* RESTRICT offset;
    GLOBAL real* RESTRICT direction;
    int stride;
} limit_step_args;

KERNEL_FN void limit_step_vertex(int vertex, const limit_step_args* a)
{
    vec3 n = load3(a->normal, a->stride, vertex), d = load3(a->direction, a->stride, vertex);
    real gap = dot(n, load3(a->pos, a->stride, vertex)) - a->offset[vertex];
    real excess = larger(gap, REAL(0)) * -LIMIT_STEP_PART - dot(n, d);
    if (gap > REAL(0) && excess > REAL(0) && dot(n, n) > REAL(0))
        store3(a->direction, a->stride, vertex, d + excess * n);
}

// By how many times the direction exceeds the part of a vertex's gap that one move may take.
KERNEL_FN real limit_step_excess(int vertex, const limit_step_args* a)
{
    real gap = -a->offset[vertex], approach = 0;
    for (int i = vertex; i < 3 * a->stride; i += a->stride) {
        gap += a->normal[i] * a->pos[i];
        approach -= a->normal[i] * a->direction[i];
    }
    return gap > REAL(0) ? approach / (gap * LIMIT_STEP_PART) : REAL(0);
}

typedef struct {
    GLOBAL const real* RESTRICT normal;
    GLOBAL const real* RESTRICT direction;
    real near_bodies, elsewhere;  // longest moves of a vertex with and without a contact plane [m]
    int stride;
} limit_move_args;

// The length of a vertex's direction over that of its longest move.
KERNEL_FN real limit_move_excess(int vertex, const limit_move_args* a)
{
    real square_move = 0, square_normal = 0;
    for (int i = vertex; i < 3 * a->stride; i += a->stride) {
        square_move += a->direction[i] * a->direction[i];
        square_normal += a->normal[i] * a->normal[i];
    }
    return sqrt(square_move) / (square_normal > REAL(0) ? a->near_bodies : a->elsewhere);
}
