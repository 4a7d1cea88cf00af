// The velocity rule: contact of vertices with bodies by a velocity filter instead of a force. n is the normal of the
// nearest surface, g = n . x - offset the gap, d the gap at which a vertex touches, v_n = (v . n) n and v_t = v - v_n.
//     sliding if |v_t| > k_f |v_n|:   v_t' = v_t - k_f |v_n| v_t / |v_t|,     else v_t' = 0
//     v' = v_t' - k_r v_n             where g < d and v . n < 0
// k_r is the coefficient of restitution, k_f Coulomb's coefficient. The vertex touched the surface the time
// t = (d - g) / |v_n| ago, at most one step; the position is corrected as if v' had acted since then:
// x' = x + t (v' - v). A vertex that is still closer than d, or was leaving already, is projected to g = d.
// Source: a thesis on garment models from photographed panels. Unlike the printed rule this one leaves departing
// vertices alone, which the printed rule would turn back.
// Limits: the rule sees vertices only, not edges, faces or cloth on cloth. A vertex can pass through anything thinner
// than its displacement in a step, and a vertex at rest has no contact force.
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
