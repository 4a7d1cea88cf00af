// Exponential repulsion of a vertex from the nearest body surface, which is its tangent plane while a step is solved.
//     g = n . x - offset  [m],    s = g / d
//     E = A P d Q(s)  [J]         f = A P q(s) n  [N]         stiffness -A P q'(s)/d n n^T  [N/m]
// g is the gap, d where contact sets in, P a pressure, A vertex area times hardness. It replaces body_contact and
// is meant for comparison: its force is bounded, so it cannot guarantee that nothing penetrates.
// Source: repulsion.h for q and Q; A P is the source's c_r.
#pragma once
#include "../repulsion.h"
#include "../term_args.h"

#define body_repulsion_PARAMS(STRENGTH, PARAM)                                 \
    STRENGTH(stiffness, 0.0, "Pa", "pressure scale of the exponential law, P") \
    PARAM(gap, 0.002, "m", "distance at which contact sets in, d")
// clang-format off
#define body_repulsion_FIELDS(READ, ADD) READ(pos) READ(contact_normal) READ(contact_offset)       \
    READ(contact_area) READ(contact_hardness) ADD(force) ADD(vertex_stiffness)
// clang-format on
TERM_ARGS(body_repulsion)

// The pressure scale of the vertex, times its area [N].
KERNEL_FN real body_repulsion_scale(int vertex, const body_repulsion_args* a)
{
    return a->contact_area[vertex] * a->contact_hardness[vertex] * a->stiffness;
}

KERNEL_FN barrier_jet body_repulsion_at(int vertex, const body_repulsion_args* a)
{
    int vs = a->size.vertex_stride;
    real g = dot(load3(a->contact_normal, vs, vertex), load3(a->pos, vs, vertex)) - a->contact_offset[vertex];
    return repulsion_at(g / a->gap);
}

KERNEL_FN real body_repulsion_energy(int vertex, const body_repulsion_args* a)
{
    return body_repulsion_scale(vertex, a) * a->gap * body_repulsion_at(vertex, a).value;
}

// Normal force, positive when the body pushes [N].
KERNEL_FN real body_repulsion_push(int vertex, const body_repulsion_args* a)
{
    return -body_repulsion_scale(vertex, a) * body_repulsion_at(vertex, a).slope;
}

KERNEL_FN void body_repulsion_force(int vertex, const body_repulsion_args* a)
{
    int vs = a->size.vertex_stride;
    add3(a->force, vs, vertex, body_repulsion_push(vertex, a) * load3(a->contact_normal, vs, vertex));
}

KERNEL_FN void body_repulsion_stiffness(int vertex, const body_repulsion_args* a)
{
    int vs = a->size.vertex_stride;
    vec3 n = load3(a->contact_normal, vs, vertex);
    real k = body_repulsion_scale(vertex, a) / a->gap * body_repulsion_at(vertex, a).curvature;
    add_block(a->vertex_stiffness, vs, vertex, 0, outer3(k, n, n));
}
