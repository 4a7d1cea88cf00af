// Contact of a vertex with the nearest body surface, taken as its tangent plane while a step is solved.
//     g = n . x - offset  [m]     gap;   s = g / d;   d the gap at which contact sets in, P a pressure, A the vertex area
//     E = A P d b(s)  [J]         f = -A P b'(s) n  [N]      stiffness A P b''(s)/d n n^T  [N/m]
//     s >= 1:        b = 0
//     s0 < s < 1:    b = -(s - 1)^2 ln s
//     -1 < s <= s0:  the second-order continuation of b at s0 = 0.02
//     s <= -1:       its tangent: a vertex that starts deep inside is pushed out with a bounded force
// Source: barrier of Li and others 2020, eq. 6, continued so that cloth that starts inside a body has a finite force.
#pragma once
#include "../term_args.h"

#define body_contact_PARAMS(STRENGTH, PARAM)                                                       \
    STRENGTH(stiffness, 0.0, "Pa", "pressure scale of the barrier, P")                             \
    PARAM(gap, 0.002, "m", "distance at which contact sets in, d")
#define body_contact_FIELDS(READ, ADD)                                                             \
    READ(pos) READ(contact_normal) READ(contact_offset) READ(contact_area) ADD(force) ADD(vertex_stiffness)
TERM_ARGS(body_contact)

typedef struct { real value, slope, curvature; } barrier_jet;

KERNEL_FN barrier_jet body_contact_log_barrier(real s)
{
    real u = s - REAL(1), l = log(s);
    barrier_jet b;
    b.value = -u * u * l;
    b.slope = REAL(-2) * u * l - u * u / s;
    b.curvature = REAL(-2) * l - REAL(4) * u / s + u * u / (s * s);
    return b;
}

KERNEL_FN barrier_jet body_contact_barrier(real s)
{
    const real s0 = REAL(0.02);
    barrier_jet b;
    b.value = b.slope = b.curvature = REAL(0);
    if (s >= REAL(1)) return b;
    b = body_contact_log_barrier(fmax(s, s0));
    if (s >= s0) return b;
    real d = fmax(s, REAL(-1)) - s0;
    b.value += d * (b.slope + REAL(0.5) * d * b.curvature);
    b.slope += d * b.curvature;
    if (s > REAL(-1)) return b;
    b.value += (s + REAL(1)) * b.slope;
    b.curvature = REAL(0);
    return b;
}

KERNEL_FN barrier_jet body_contact_at(int vertex, const body_contact_args* a)
{
    int vs = a->size.vertex_stride;
    real g = dot(load3(a->contact_normal, vs, vertex), load3(a->pos, vs, vertex)) - a->contact_offset[vertex];
    return body_contact_barrier(g / a->gap);
}

KERNEL_FN real body_contact_energy(int vertex, const body_contact_args* a)
{
    return a->contact_area[vertex] * a->stiffness * a->gap * body_contact_at(vertex, a).value;
}

// Normal force, positive when the body pushes [N].
KERNEL_FN real body_contact_pressure_force(int vertex, const body_contact_args* a)
{
    return -a->contact_area[vertex] * a->stiffness * body_contact_at(vertex, a).slope;
}

KERNEL_FN void body_contact_force(int vertex, const body_contact_args* a)
{
    int vs = a->size.vertex_stride;
    add3(a->force, vs, vertex, body_contact_pressure_force(vertex, a) * load3(a->contact_normal, vs, vertex));
}

KERNEL_FN void body_contact_stiffness(int vertex, const body_contact_args* a)
{
    int vs = a->size.vertex_stride;
    vec3 n = load3(a->contact_normal, vs, vertex);
    real k = a->contact_area[vertex] * a->stiffness / a->gap * body_contact_at(vertex, a).curvature;
    add_block(a->vertex_stiffness, vs, vertex, 0, outer3(k, n, n));
}
