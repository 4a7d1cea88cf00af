// Bending hysteresis from the friction between yarns. Each hinge is tied to an elastic anchor that slips at the moment
// L, called the hinge's friction moment.
//     phi = 2 (sin(theta/2) - sin(theta0/2)),  w = phi - anchor,  q = |w|,  r = stick curvature * width of the hinge
//     q <= r:  E = L q^2 / (2 r),    M = L w / r         (sticks: elastic return to the anchor)
//     q >  r:  E = L (q - r / 2),    M = L w / q         (slips: |M| = L)
//     f_i = -M cos(theta/2) dtheta/dx_i
// After every step a slipping hinge drags its anchor so that q <= r (stages/settle_hysteresis.h). A cloth that is bent
// to and fro then has a hysteresis loop of width 2HB around its elastic moment. host/solver/state/hysteresis.hpp
// chooses L so that this width does not depend on the mesh.
// The projected stiffness drops M d2phi/dx2 and uses the secant M / w in place of the tangent dM/dphi. The secant is
// never negative, and it stays positive for a slipping hinge, which sticks again as soon as its motion reverses.
// Source: a frictional couple beside the rigidity as in Grosberg 1966 and Kawabata 1980. The elastic anchor is that of
// terms/friction.h. The default of the stick curvature was chosen by hand; not measured.
#pragma once
#include "../hinge.h"

#define bending_hysteresis_PARAMS(STRENGTH, PARAM)                        \
    STRENGTH(scale, 0.0, "1", "multiplies every hinge's friction moment") \
    PARAM(stick_curvature, 2.0, "1/m", "elastic change of curvature before yarns slip")
// clang-format off
#define bending_hysteresis_FIELDS(READ, ADD)                                                        \
    READ(pos) READ(hinge_vertex) READ(hinge_rest_sine) READ(hinge_hysteresis) READ(hinge_width)     \
    READ(hinge_anchor) ADD(hinge_force) ADD(hinge_stiffness)
// clang-format on
TERM_ARGS(bending_hysteresis)

// The elastic turn w of the hinge from its anchor [1].
KERNEL_FN real bending_hysteresis_turn(int hinge, const hinge_state* h, const bending_hysteresis_args* a)
{
    return REAL(2) * (h->sine - a->hinge_rest_sine[hinge]) - a->hinge_anchor[hinge];
}

KERNEL_FN real bending_hysteresis_energy(int hinge, const bending_hysteresis_args* a)
{
    hinge_state h = hinge_at(hinge, a->size, a->pos, a->hinge_vertex);
    real q = fabs(bending_hysteresis_turn(hinge, &h, a)), r = a->stick_curvature * a->hinge_width[hinge];
    real limit = a->scale * a->hinge_hysteresis[hinge];
    return q <= r ? limit * q * q / (REAL(2) * r) : limit * (q - REAL(0.5) * r);
}

KERNEL_FN void bending_hysteresis_force(int hinge, const bending_hysteresis_args* a)
{
    int hs = a->size.hinge_stride;
    hinge_state h = hinge_at(hinge, a->size, a->pos, a->hinge_vertex);
    real w = bending_hysteresis_turn(hinge, &h, a), r = a->stick_curvature * a->hinge_width[hinge];
    real moment = a->scale * a->hinge_hysteresis[hinge] * w / larger(fabs(w), r) * h.cosine;
    for (int i = 0; i < 4; ++i) add3(a->hinge_force + 3 * i * hs, hs, hinge, (-moment) * h.g[i]);
}

KERNEL_FN void bending_hysteresis_stiffness(int hinge, const bending_hysteresis_args* a)
{
    int hs = a->size.hinge_stride;
    hinge_state h = hinge_at(hinge, a->size, a->pos, a->hinge_vertex);
    real w = bending_hysteresis_turn(hinge, &h, a), r = a->stick_curvature * a->hinge_width[hinge];
    real secant = a->scale * a->hinge_hysteresis[hinge] / larger(fabs(w), r), moment = secant * w;
    real along = secant * h.cosine * h.cosine;
    mat3 t[4][4];
    if (!a->mode.projected) {
        hinge_angle_hessian(&h, t);
        along = (fabs(w) <= r ? along : REAL(0)) - REAL(0.5) * moment * h.sine;
    }
    for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) {
            mat3 k = outer3(along, h.g[i], h.g[j]);
            if (!a->mode.projected) k = mat3_add(k, mat3_scale(moment * h.cosine, t[i][j]));
            add_block(a->hinge_stiffness, hs, hinge, block_index(4, i, j), k);
        }
}
