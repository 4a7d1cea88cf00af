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
