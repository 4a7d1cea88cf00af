// Coulomb friction with true sticking: a vertex in contact hangs on an elastic anchor that slips at the limit L = mu N.
//     w = (I - n n^T)(x - anchor),  q = |w|,  r the stick distance
//     q <= r:  E = L q^2 / (2 r),    f = -L w / r         (sticks: returns to its anchor)
//     q >  r:  E = L (q - r / 2),    f = -L w / q         (slides: |f| = mu N)
// After every step the anchor is drawn along so that q <= r, and L follows the normal force.
// Source: Coulomb's law (D10); the elastic anchor is that of Cundall and Strack 1979 in a step's incremental form.
// While a vertex sticks nothing creeps, whatever the step: a friction law on velocities alone would.
#pragma once
#include "../term_args.h"

#define friction_PARAMS(STRENGTH, PARAM)                               \
    STRENGTH(scale, 0.0, "1", "multiplies every friction coefficient") \
    PARAM(stick_distance, 2e-4, "m", "elastic way before a vertex slides, r")
// clang-format off
#define friction_FIELDS(READ, ADD)                                                                 \
    READ(pos) READ(contact_normal) READ(contact_friction) READ(friction_anchor) READ(friction_limit) \
    ADD(force) ADD(vertex_stiffness)
// clang-format on
TERM_ARGS(friction)

KERNEL_FN vec3 friction_way(int vertex, const friction_args* a)
{
    int vs = a->size.vertex_stride;
    vec3 n = load3(a->contact_normal, vs, vertex);
    vec3 d = load3(a->pos, vs, vertex) - load3(a->friction_anchor, vs, vertex);
    return d - dot(n, d) * n;
}

KERNEL_FN real friction_energy(int vertex, const friction_args* a)
{
    real q = length(friction_way(vertex, a)), r = a->stick_distance, limit = a->scale * a->friction_limit[vertex];
    return q <= r ? limit * q * q / (REAL(2) * r) : limit * (q - REAL(0.5) * r);
}

KERNEL_FN void friction_force(int vertex, const friction_args* a)
{
    vec3 w = friction_way(vertex, a);
    real limit = a->scale * a->friction_limit[vertex];
    add3(a->force, a->size.vertex_stride, vertex, (-limit / larger(length(w), a->stick_distance)) * w);
}

// Stiffness L / max(q, r) across the normal, less its part along w when sliding in the exact form.
KERNEL_FN void friction_stiffness(int vertex, const friction_args* a)
{
    int vs = a->size.vertex_stride;
    real limit = a->scale * a->friction_limit[vertex];
    vec3 n = load3(a->contact_normal, vs, vertex), w = friction_way(vertex, a);
    real q = length(w), k = limit / larger(q, a->stick_distance);
    mat3 m = mat3_add_diagonal(outer3(-k, n, n), k * dot(n, n));
    if (q > a->stick_distance) m = mat3_add(m, outer3(-k / (q * q), w, w));
    add_block(a->vertex_stiffness, vs, vertex, 0, m);
}
