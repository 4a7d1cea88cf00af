// Coulomb friction with elastic sticking: a vertex in contact is tied to an elastic anchor that slips at L = mu N.
//     w = (I - n n^T)(x - anchor),  q = |w|,  r the stick distance
//     q <= r:  E = L q^2 / (2 r),    f = -L w / r         (sticks: elastic return to the anchor)
//     q >  r:  E = L (q - r / 2),    f = -L w / q         (slides: |f| = mu N)
// After every step a sliding vertex drags its anchor so that q <= r, and L is updated from the normal force
// (stages/settle_friction.h). A sticking vertex does not creep at any step size, as it would under a friction law that
// depends on velocities alone.
// Source: Coulomb's law; the elastic anchor is that of Cundall and Strack 1979 in incremental form. The default of the
// stick distance was chosen by hand; not measured.
#pragma once
#include "../term_args.h"

#define friction_PARAMS(STRENGTH, PARAM)                               \
    STRENGTH(scale, 0.0, "1", "multiplies every friction coefficient") \
    PARAM(stick_distance, 2e-4, "m", "elastic displacement before a vertex slides, r")
// clang-format off
#define friction_FIELDS(READ, ADD)                                                                 \
    READ(pos) READ(contact_normal) READ(contact_friction) READ(friction_anchor) READ(friction_limit) \
    ADD(force) ADD(vertex_stiffness)
// clang-format on
TERM_ARGS(friction)

// The elastic displacement w of the vertex from its anchor, in the tangent plane [m].
KERNEL_FN vec3 friction_slip(int vertex, const friction_args* a)
{
    int vs = a->size.vertex_stride;
    vec3 n = load3(a->contact_normal, vs, vertex);
    vec3 d = load3(a->pos, vs, vertex) - load3(a->friction_anchor, vs, vertex);
    return d - dot(n, d) * n;
}

KERNEL_FN real friction_energy(int vertex, const friction_args* a)
{
    real q = length(friction_slip(vertex, a)), r = a->stick_distance, limit = a->scale * a->friction_limit[vertex];
    return q <= r ? limit * q * q / (REAL(2) * r) : limit * (q - REAL(0.5) * r);
}

KERNEL_FN void friction_force(int vertex, const friction_args* a)
{
    vec3 w = friction_slip(vertex, a);
    real limit = a->scale * a->friction_limit[vertex];
    add3(a->force, a->size.vertex_stride, vertex, (-limit / larger(length(w), a->stick_distance)) * w);
}

// The stiffness is L / max(q, r) in the tangent plane, and zero along w when sliding.
KERNEL_FN void friction_stiffness(int vertex, const friction_args* a)
{
    int vs = a->size.vertex_stride;
    real limit = a->scale * a->friction_limit[vertex];
    vec3 n = load3(a->contact_normal, vs, vertex), w = friction_slip(vertex, a);
    real q = length(w), k = limit / larger(q, a->stick_distance);
    mat3 m = mat3_add_diagonal(outer3(-k, n, n), k * dot(n, n));
    if (q > a->stick_distance) m = mat3_add(m, outer3(-k / (q * q), w, w));
    add_block(a->vertex_stiffness, vs, vertex, 0, m);
}
