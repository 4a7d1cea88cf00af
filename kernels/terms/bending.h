// Bending of a hinge: the edge x0 x1 with faces (0, 1, 2) and (1, 0, 3), dihedral angle theta, 0 when flat.
//     c = D |e|^2 / (A1 + A2)                                       (rest lengths and areas; stored per hinge)
//     M = 2 c (sin(theta/2) - sin(theta0/2))  [N m]                 f_i = -M dtheta/dx_i  [N]
//     E = c (4 (cos(theta0/2) - cos(theta/2)) - 2 (theta - theta0) sin(theta0/2))  [J]
// For small angles E = c/2 (theta - theta0)^2. The source's stiffness is k_e = 4 D.
// Source: Bridson, Marino and Fedkiw 2003, section 4.
// The effective rigidity of a sheet of such hinges depends on the mesh (0.75 to 3 times D); that of plate.h does not.
// The projected stiffness drops M d2theta/dx2. The rest, c cos(theta/2) g g^T with g = dtheta/dx, is positive
// semidefinite.
#pragma once
#include "../hinge.h"

#define bending_PARAMS(STRENGTH, PARAM) STRENGTH(scale, 0.0, "1", "multiplies every bending rigidity")
// clang-format off
#define bending_FIELDS(READ, ADD)                                                                   \
    READ(pos) READ(hinge_vertex) READ(hinge_rigidity) READ(hinge_rest_sine) ADD(hinge_force)         \
    ADD(hinge_stiffness)
// clang-format on
TERM_ARGS(bending)

KERNEL_FN real bending_energy(int hinge, const bending_args* a)
{
    hinge_state h = hinge_at(hinge, a->size, a->pos, a->hinge_vertex);
    real s0 = a->hinge_rest_sine[hinge], c0 = sqrt(REAL(1) - s0 * s0);
    if (s0 == REAL(0))  // 1 - cos without cancellation at small angles
        return REAL(4) * a->scale * a->hinge_rigidity[hinge] * h.sine * h.sine / (REAL(1) + h.cosine);
    real turn = REAL(2) * (asin(smaller(larger(h.sine, REAL(-1)), REAL(1))) - asin(s0));
    return a->scale * a->hinge_rigidity[hinge] * (REAL(4) * (c0 - h.cosine) - REAL(2) * turn * s0);
}

KERNEL_FN void bending_force(int hinge, const bending_args* a)
{
    int hs = a->size.hinge_stride;
    hinge_state h = hinge_at(hinge, a->size, a->pos, a->hinge_vertex);
    real moment = REAL(2) * a->scale * a->hinge_rigidity[hinge] * (h.sine - a->hinge_rest_sine[hinge]);
    for (int i = 0; i < 4; ++i) add3(a->hinge_force + 3 * i * hs, hs, hinge, (-moment) * h.g[i]);
}

KERNEL_FN void bending_stiffness(int hinge, const bending_args* a)
{
    int hs = a->size.hinge_stride;
    hinge_state h = hinge_at(hinge, a->size, a->pos, a->hinge_vertex);
    real c = a->scale * a->hinge_rigidity[hinge];
    real moment = REAL(2) * c * (h.sine - a->hinge_rest_sine[hinge]);
    mat3 t[4][4];
    if (!a->mode.projected) hinge_angle_hessian(&h, t);
    for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) {
            mat3 k = outer3(c * h.cosine, h.g[i], h.g[j]);
            if (!a->mode.projected) k = mat3_add(k, mat3_scale(moment, t[i][j]));
            add_block(a->hinge_stiffness, hs, hinge, block_index(4, i, j), k);
        }
}
