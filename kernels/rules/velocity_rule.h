// The velocity rule of contact: what a vertex on a body's surface does instead of being pressed by it. n is the
// surface's normal, g = n . x - offset the gap, d the gap at which the vertex touches; with v_n = (v . n) n, v_t = v -
// v_n:
//     sliding if |v_t| > k_f |v_n|:   v_t' = v_t - k_f |v_n| v_t / |v_t|,     else v_t' = 0
//     v' = v_t' - k_r v_n             where g < d and v . n < 0
// It acts from when the vertex touched, t = (d - g) / |v_n| ago but at most a step, so that it also moves to where v'
// would have taken it: x' = x + t (v' - v). What is beyond the surface still, or moves out already, is put on it.
// Source: the thesis on photographed panels (B15), applied to vertices that approach only: as printed it would turn
// those back that leave. k_r is the restitution, k_f Coulomb's coefficient. Nothing here knows of edges, faces or cloth
// on cloth, nor of forces: a vertex may pass through what is thinner than its way in a step, and it has no force at
// rest.
#pragma once
#include "../term_args.h"

#define velocity_rule_PARAMS(STRENGTH, PARAM)                                             \
    STRENGTH(gap, 0.0, "m", "distance from a body at which a vertex touches it, d")       \
    PARAM(restitution, 0.0, "1", "normal velocity after an impact over that before, k_r") \
    PARAM(friction, 0.0, "1", "multiplies every friction coefficient")
// clang-format off
#define velocity_rule_FIELDS(READ, ADD)                                                            \
    READ(inv_mass) READ(contact_normal) READ(contact_offset) READ(contact_friction) ADD(pos) ADD(vel)
// clang-format on
TERM_ARGS(velocity_rule)

KERNEL_FN void velocity_rule_apply(int vertex, real dt, const velocity_rule_args* a)
{
    int vs = a->size.vertex_stride;
    vec3 n = load3(a->contact_normal, vs, vertex), x = load3(a->pos, vs, vertex), v = load3(a->vel, vs, vertex);
    real beyond = a->gap + a->contact_offset[vertex] - dot(n, x), impact = -dot(n, v);
    if (a->inv_mass[vertex] == REAL(0) || dot(n, n) == REAL(0) || beyond <= REAL(0)) return;
    if (impact > REAL(0)) {
        vec3 slide = v + impact * n;
        real speed = length(slide), loss = a->friction * a->contact_friction[vertex] * impact;
        real kept = speed > loss ? REAL(1) - loss / speed : REAL(0);
        vec3 after = kept * slide + (a->restitution * impact) * n;
        x = x + smaller(dt, beyond / impact) * (after - v);
        store3(a->vel, vs, vertex, after);
    }
    beyond = a->gap + a->contact_offset[vertex] - dot(n, x);
    store3(a->pos, vs, vertex, x + larger(beyond, REAL(0)) * n);
}
