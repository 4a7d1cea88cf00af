// What Newton's method does with whole fields, vertex by vertex. Pinned vertices, whose inverse mass is 0, stay.
#pragma once
#include "../term_args.h"

typedef struct {
    GLOBAL const real* RESTRICT pos;
    GLOBAL const real* RESTRICT force;
    GLOBAL const real* RESTRICT target;
    GLOBAL const real* RESTRICT mass;
    GLOBAL const real* RESTRICT inv_mass;
    GLOBAL real* RESTRICT downhill;
    real inertia;  // 1/h^2 [1/s^2]
    int stride;
} newton_descent_args;

// downhill = f - m (x - target) / h^2
KERNEL_FN void newton_descent(int vertex, const newton_descent_args* a)
{
    for (int i = vertex; i < 3 * a->stride; i += a->stride) {
        real pull = a->inertia * a->mass[vertex] * (a->target[i] - a->pos[i]);
        a->downhill[i] = a->inv_mass[vertex] == REAL(0) ? REAL(0) : a->force[i] + pull;
    }
}

// m |x - target|^2
KERNEL_FN real newton_inertia(int vertex, const newton_descent_args* a)
{
    real square = 0;
    for (int i = vertex; i < 3 * a->stride; i += a->stride) {
        real d = a->pos[i] - a->target[i];
        square += d * d;
    }
    return a->inv_mass[vertex] == REAL(0) ? REAL(0) : a->mass[vertex] * square;
}

typedef struct {
    GLOBAL real* RESTRICT pos;
    GLOBAL real* RESTRICT vel;
    GLOBAL const real* RESTRICT base;
    GLOBAL const real* RESTRICT direction;
    GLOBAL const real* RESTRICT origin;
    GLOBAL const real* RESTRICT inv_mass;
    real fraction, inverse_span;  // of the direction; 1/h, or 0 where there is no motion [1/s]
    int stride;
} newton_move_args;

// x = base + fraction direction,   v = (x - origin) / h
KERNEL_FN void newton_move(int vertex, const newton_move_args* a)
{
    if (a->inv_mass[vertex] == REAL(0)) return;
    for (int i = vertex; i < 3 * a->stride; i += a->stride) {
        a->pos[i] = a->base[i] + a->fraction * a->direction[i];
        a->vel[i] = a->inverse_span * (a->pos[i] - a->origin[i]);
    }
}

// The same with no direction: x = base.
KERNEL_FN void newton_return(int vertex, const newton_move_args* a)
{
    if (a->inv_mass[vertex] == REAL(0)) return;
    for (int i = vertex; i < 3 * a->stride; i += a->stride) {
        a->pos[i] = a->base[i];
        a->vel[i] = a->inverse_span * (a->pos[i] - a->origin[i]);
    }
}
