// Places the friction anchor of a vertex at rest so that friction balances the tangential force, up to the limit L.
//     t = (I - n n^T) f,   anchor = x - r t / max(L, |t|)   where v = 0 and L > 0
// f is the sum of all other forces on the vertex, r the stick distance. Without this, cloth that starts at rest would
// first accelerate over the elastic range of its anchors, and would then slide off where friction barely holds it.
// Source: Coulomb's law at rest; see terms/friction.h.
#pragma once
#include "../term_args.h"

// clang-format off
#define hold_friction_FIELDS(READ, ADD) \
    READ(pos) READ(vel) READ(force) READ(contact_normal) READ(friction_limit) ADD(friction_anchor)
// clang-format on

typedef struct {
    hold_friction_FIELDS(ARG_READ, ARG_ADD) real stick_distance;
    int stride;
} hold_friction_args;

KERNEL_FN void hold_friction_vertex(int vertex, const hold_friction_args* a)
{
    vec3 v = load3(a->vel, a->stride, vertex), n = load3(a->contact_normal, a->stride, vertex);
    real limit = a->friction_limit[vertex];
    if (limit <= REAL(0) || dot(v, v) > REAL(0)) return;
    vec3 f = load3(a->force, a->stride, vertex), t = f - dot(n, f) * n;
    real compliance = a->stick_distance / larger(limit, length(t));  // [m/N]
    store3(a->friction_anchor, a->stride, vertex, load3(a->pos, a->stride, vertex) - compliance * t);
}
