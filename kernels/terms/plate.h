// Bending of a plate made of hinges that are coupled, so that it shows the fabric's rigidity on any mesh.
//     phi_h = 2 (sin(theta_h/2) - sin(theta0_h/2))                  (the hinge's turn, theta for small angles)
//     E = 1/2 sum_hk phi_h G_hk phi_k  [J]                          M_h = sum_k G_hk phi_k  [N m]
//     f_i = -sum_h M_h cos(theta_h/2) dtheta_h/dx_i  [N]
// G comes from the rest mesh once (host/solver/state/plate.cpp): a curvature tensor per face from the turns of the
// hinges around it, with the fabric's rigidities. Source: a curvature tensor per triangle as in Grinspun and others
// 2006 and Morley 1971, the share of a hinge's turn that belongs to each side being matched to quadratic surfaces. The
// projected stiffness drops M d2phi/dx2; what is left, J^T G J with the slopes J = dphi/dx, is never negative. It
// reaches far: 37 blocks a row. The slots take only J^T W J, W diagonal (plate_diagonal); the linear solver adds J^T (G
// - W) J by hinge turns and moments, from the slopes that the stiffness function leaves behind.
#pragma once
#include "../hinge.h"

#define plate_PARAMS(STRENGTH, PARAM) STRENGTH(scale, 0.0, "1", "multiplies every bending rigidity")
// clang-format off
#define plate_FIELDS(READ, ADD)                                                                              \
    READ(pos) READ(inv_mass) READ(hinge_vertex) READ(plate_diagonal) READ(hinge_rest_sine)                    \
    READ(coupling_slots) READ(coupling_hinge) READ(coupling_rigidity) ADD(hinge_bend) ADD(hinge_slope)        \
    ADD(hinge_force) ADD(hinge_stiffness)
// clang-format on
TERM_ARGS(plate)

// Before anything else: every hinge's turn, which its neighbours need.
KERNEL_FN void plate_turns(int hinge, const plate_args* a)
{
    hinge_state h = hinge_at(hinge, a->size, a->pos, a->hinge_vertex);
    a->hinge_bend[hinge] = REAL(2) * (h.sine - a->hinge_rest_sine[hinge]);
}

KERNEL_FN real plate_moment(int hinge, const plate_args* a)
{
    real moment = 0;
    int end = a->coupling_slots[a->size.hinge_stride + hinge];
    for (int k = a->coupling_slots[hinge]; k < end; ++k)
        moment += a->coupling_rigidity[k] * a->hinge_bend[a->coupling_hinge[k]];
    return a->scale * moment;
}

KERNEL_FN real plate_energy(int hinge, const plate_args* a)
{
    return REAL(0.5) * a->hinge_bend[hinge] * plate_moment(hinge, a);
}

KERNEL_FN void plate_force(int hinge, const plate_args* a)
{
    int hs = a->size.hinge_stride;
    hinge_state h = hinge_at(hinge, a->size, a->pos, a->hinge_vertex);
    real moment = plate_moment(hinge, a) * h.cosine;
    for (int i = 0; i < 4; ++i) add3(a->hinge_force + 3 * i * hs, hs, hinge, (-moment) * h.g[i]);
}

KERNEL_FN void plate_stiffness(int hinge, const plate_args* a)
{
    int hs = a->size.hinge_stride;
    hinge_state h = hinge_at(hinge, a->size, a->pos, a->hinge_vertex);
    real along = a->scale * a->plate_diagonal[hinge] * h.cosine * h.cosine, turn = 0;
    mat3 t[4][4];
    if (!a->mode.projected) {
        real moment = plate_moment(hinge, a);
        hinge_angle_hessian(&h, t);
        along -= REAL(0.5) * moment * h.sine;
        turn = moment * h.cosine;
    }
    for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) {
            mat3 k = outer3(along, h.g[i], h.g[j]);
            if (!a->mode.projected) k = mat3_add(k, mat3_scale(turn, t[i][j]));
            add_block(a->hinge_stiffness, hs, hinge, block_index(4, i, j), k);
        }
    for (int i = 0; i < 4; ++i) {
        // A held vertex turns no hinge.
        int held = a->inv_mass[a->hinge_vertex[i * hs + hinge]] == REAL(0);
        vec3 slope = (held ? REAL(0) : sqrt(a->scale) * h.cosine) * h.g[i];
        GLOBAL block_real* to = a->hinge_slope + 12 * hinge + 3 * i;
        to[0] = (block_real)slope.x;
        to[1] = (block_real)slope.y;
        to[2] = (block_real)slope.z;
    }
}
