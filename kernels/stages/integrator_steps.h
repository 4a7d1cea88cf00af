// What the schemes of time integration do with whole fields, entry by entry; the schemes' own files derive it.
// A way is a difference of positions, a gain one of velocities: with them pinned vertices stay to the last bit.
#pragma once
#include "../portable.h"

typedef struct {
    GLOBAL real* RESTRICT pos;
    GLOBAL real* RESTRICT vel;
    GLOBAL real* RESTRICT way;         // of the step before; then minus the position that the step starts from
    GLOBAL real* RESTRICT gain;        // likewise
    GLOBAL real* RESTRICT older_way;   // of the step before that
    GLOBAL real* RESTRICT older_gain;  // likewise
    GLOBAL real* RESTRICT origin;
    GLOBAL real* RESTRICT target;
    GLOBAL real* RESTRICT guess;
    real dt, w, h;     // length of the step, and of it over the one before's; span of the solve
    real last, older;  // weights of the ways and gains
    real parabola;     // w^2 where the guess is to go through both last positions with the last velocity, or 0
    int doubled;       // 1: a step of the midpoint rule, which goes as far again as was solved for
} bdf2_args;

KERNEL_FN void bdf2_start(int i, const bdf2_args* a)
{
    a->origin[i] = a->pos[i] + a->last * a->way[i] + a->older * a->older_way[i];
    a->target[i] = a->origin[i] + a->h * (a->vel[i] + a->last * a->gain[i] + a->older * a->older_gain[i]);
    a->guess[i] = a->pos[i] + a->dt * a->vel[i] +
                  (a->parabola > REAL(0) ? a->parabola * (a->dt / a->w * a->vel[i] - a->way[i]) : REAL(0));
    a->older_way[i] = a->way[i];
    a->older_gain[i] = a->gain[i];
    a->way[i] = -a->pos[i];
    a->gain[i] = -a->vel[i];
}

KERNEL_FN void bdf2_finish(int i, const bdf2_args* a)
{
    a->way[i] += a->pos[i];
    a->gain[i] += a->vel[i];
    if (!a->doubled) return;
    a->pos[i] += a->way[i];
    a->vel[i] += a->gain[i];
    a->way[i] *= REAL(2);
    a->gain[i] *= REAL(2);
}

typedef struct {
    GLOBAL real* RESTRICT pos;
    GLOBAL real* RESTRICT vel;
    GLOBAL real* RESTRICT acceleration;
    GLOBAL const real* RESTRICT start;
    GLOBAL const real* RESTRICT start_vel;
    real dt;
} midpoint_args;

// From the middle of the step to its end.
KERNEL_FN void midpoint_finish(int i, const midpoint_args* a)
{
    a->pos[i] += a->pos[i] - a->start[i];
    a->vel[i] += a->vel[i] - a->start_vel[i];
    a->acceleration[i] = (a->vel[i] - a->start_vel[i]) / a->dt;
}

typedef struct {
    GLOBAL real* RESTRICT pos;
    GLOBAL real* RESTRICT vel;
    GLOBAL real* RESTRICT way;
    GLOBAL const real* RESTRICT acceleration;
    real dt, last_dt;  // last_dt 0: there is no step before
} central_args;

// The way that a step of this length would have come after one of another.
KERNEL_FN void central_restart(int i, const central_args* a)
{
    real last = a->last_dt, acceleration = a->acceleration[i];
    real velocity = last > REAL(0) ? a->way[i] / last + REAL(0.5) * last * acceleration : a->vel[i];
    a->way[i] = a->dt * (velocity - REAL(0.5) * a->dt * acceleration);
}

KERNEL_FN void central_finish(int i, const central_args* a)
{
    a->pos[i] += a->way[i];
    a->vel[i] = a->way[i] / a->dt + REAL(0.5) * a->dt * a->acceleration[i];
}

typedef struct {
    GLOBAL real* RESTRICT pos;
    GLOBAL real* RESTRICT vel;
    GLOBAL const real* RESTRICT acceleration;
    GLOBAL const real* RESTRICT next;  // acceleration at the end of the step
    real dt;
} verlet_args;

KERNEL_FN void verlet_start(int i, const verlet_args* a)
{
    a->pos[i] += a->dt * (a->vel[i] + REAL(0.5) * a->dt * a->acceleration[i]);
    a->vel[i] += a->dt * a->acceleration[i];
}

KERNEL_FN void verlet_finish(int i, const verlet_args* a)
{
    a->vel[i] += REAL(0.5) * a->dt * (a->next[i] - a->acceleration[i]);
}

typedef struct {
    GLOBAL real* RESTRICT q;
    GLOBAL real* RESTRICT before;
    GLOBAL const real* RESTRICT w;
    real along, last;
} lanczos_args;

// q, before = w - along q - last before, q: the next direction of the Lanczos recurrence, not yet of unit length.
KERNEL_FN void lanczos_advance(int i, const lanczos_args* a)
{
    real next = a->w[i] - a->along * a->q[i] - a->last * a->before[i];
    a->before[i] = a->q[i];
    a->q[i] = next;
}

typedef struct {
    GLOBAL const block_real* RESTRICT drag;  // a block of d2R/dv2 per vertex [kg/s]
    GLOBAL const real* RESTRICT inv_mass;
} drag_rate_args;

// A bound of the eigenvalues of a vertex' drag over its mass: the largest sum of magnitudes in a row [1/s].
KERNEL_FN real drag_rate(int vertex, const drag_rate_args* a)
{
    real widest = 0;
    for (int row = 0; row < 3; ++row) {
        real sum = 0;
        for (int c = 0; c < 3; ++c) sum += fabs((real)a->drag[9 * vertex + 3 * row + c]);
        widest = larger(sum, widest);
    }
    return widest * a->inv_mass[vertex];
}
