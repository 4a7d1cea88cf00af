// Plate bending by coupled hinges: the coupling makes the effective rigidity equal to the fabric's on any mesh.
//     phi_h = 2 (sin(theta_h/2) - sin(theta0_h/2))                  (the hinge's turn; theta - theta0 if small)
//     E = 1/2 sum_hk phi_h G_hk phi_k  [J]                          M_h = sum_k G_hk phi_k  [N m]
//     f_i = -sum_h M_h cos(theta_h/2) dtheta_h/dx_i  [N]
// G is computed once from the rest mesh and the fabric's rigidities (host/solver/state/plate.cpp): each face has a
// curvature tensor that is linear in the turns of the hinges around it.
// Source: a curvature tensor per triangle as in Grinspun and others 2006 and Morley 1971. How a hinge's turn is divided
// between its two faces is fitted to quadratic surfaces.
// The projected stiffness drops M d2phi/dx2. The rest, J^T G J with J = dphi/dx, is positive semidefinite but has 37
// blocks a row. Only J^T W J goes to the stiffness slots, with W diagonal (plate_diagonal). The linear solver adds
// J^T (G - W) J to its products by way of hinge turns and moments (stages/couple_hinges.h); it reads J from
// hinge_slope, which the stiffness function fills.
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

// The stage that runs before each function of the term: computes all turns, since a moment depends on several of them.
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
        // A pinned vertex does not move in a linear solve, so it turns no hinge.
        int held = a->inv_mass[a->hinge_vertex[i * hs + hinge]] == REAL(0);
        vec3 slope = (held ? REAL(0) : sqrt(a->scale) * h.cosine) * h.g[i];
        GLOBAL block_real* to = a->hinge_slope + 12 * hinge + 3 * i;
        to[0] = (block_real)slope.x;
        to[1] = (block_real)slope.y;
        to[2] = (block_real)slope.z;
    }
}
