// Coulomb friction in a pair in contact, with elastic sticking; friction.h is the same for a vertex on a body.
//     w = (I - n n^T)(sum_i w_i x_i) + bristle,  q = |w|,  r the stick distance, L = mu N
//     q <= r:  E = L q^2 / (2 r),    f_i = -w_i L w / r         (sticks: elastic return to the anchor)
//     q >  r:  E = L (q - r / 2),    f_i = -w_i L w / q         (slides: |f| = mu N)
// The weights w_i, the normal n, the bristle and L are lagged: they are those at the start of the step. The relative
// position sum_i w_i x_i has no tangential part then, so the tangential part that it gains is the slip of the step. The
// bristle is the elastic displacement at the start of the step; after the step it becomes w, shortened to r.
// Source: Coulomb's law; Cundall and Strack 1979 for the elastic displacement; Li and others 2020, chapter 5, for the
// lagged weights. The default of the stick distance was chosen by hand; not measured.
#pragma once
#include "../term_args.h"

#define cloth_friction_PARAMS(STRENGTH, PARAM)                         \
    STRENGTH(scale, 0.0, "1", "multiplies every friction coefficient") \
    PARAM(stick_distance, 2e-4, "m", "elastic displacement before a contact slides, r")
// clang-format off
#define cloth_friction_FIELDS(READ, ADD)                                                           \
    READ(pos) READ(body_point) READ(pair_vertex) READ(pair_held_weight) READ(pair_held_normal)     \
    READ(pair_bristle) READ(pair_friction) READ(pair_limit) ADD(pair_force) ADD(pair_stiffness) ADD(vertex_stiffness)
// clang-format on
TERM_ARGS(cloth_friction)

// The elastic displacement w: the bristle plus the slip of this step [m].
KERNEL_FN vec3 pair_slip(int pair, const cloth_friction_args* a)
{
    int ps = a->size.pair_stride, vs = a->size.vertex_stride;
    vec3 r = make_vec3(REAL(0), REAL(0), REAL(0)), n = load3(a->pair_held_normal, ps, pair), first = r;
    for (int i = 0; i < 4; ++i) {
        int v = a->pair_vertex[i * ps + pair];
        vec3 x = v >= 0 ? load3(a->pos, vs, v) : load3(a->body_point, a->size.body_point_stride, -1 - v);
        if (i == 0) first = x;
        r = r + a->pair_held_weight[i * ps + pair] * (x - first);
    }
    return r - dot(n, r) * n + load3(a->pair_bristle, ps, pair);
}

KERNEL_FN real cloth_friction_energy(int pair, const cloth_friction_args* a)
{
    real q = length(pair_slip(pair, a)), r = a->stick_distance, limit = a->scale * a->pair_limit[pair];
    return q <= r ? limit * q * q / (REAL(2) * r) : limit * (q - REAL(0.5) * r);
}

KERNEL_FN void cloth_friction_force(int pair, const cloth_friction_args* a)
{
    int ps = a->size.pair_stride;
    vec3 w = pair_slip(pair, a);
    vec3 drag = (-a->scale * a->pair_limit[pair] / larger(length(w), a->stick_distance)) * w;
    for (int i = 0; i < 4; ++i) add3(a->pair_force + 3 * i * ps, ps, pair, a->pair_held_weight[i * ps + pair] * drag);
}

// The stiffness is L / max(q, r) in the tangent plane, and zero along w when sliding.
KERNEL_FN void cloth_friction_stiffness(int pair, const cloth_friction_args* a)
{
    int ps = a->size.pair_stride;
    vec3 n = load3(a->pair_held_normal, ps, pair), w = pair_slip(pair, a);
    real q = length(w), k = a->scale * a->pair_limit[pair] / larger(q, a->stick_distance);
    mat3 m = mat3_add_diagonal(outer3(-k, n, n), k * dot(n, n));
    if (q > a->stick_distance) m = mat3_add(m, outer3(-k / (q * q), w, w));
    add_block(a->pair_stiffness, ps, pair, 1, m);
}
