// The constant-strain triangle in the fabric's weft (u) and warp (v) directions that every membrane law uses.
//     U = sum_j wu_j x_j,   V = sum_j wv_j x_j                     (deformed weft and warp directions)
//     e_uu = (U.U - 1)/2,   e_vv = (V.V - 1)/2,   g = U.V          (Green-Lagrange; g is twice the tensor's shear)
//     f_j = -A (s_uu wu_j U + s_vv wv_j V + s_uv (wu_j V + wv_j U))  [N]
// The weights are constant: sum w = 0, sum wu u = 1, sum wu v = 0 (and the reverse for wv).
// Source: Volino, Magnenat-Thalmann and Faure 2009, eqs. 1-12.
// The projected stiffness sets negative principal stresses and negative tangents to zero and limits the coupling to
// sqrt(ku kv). Each element matrix is then a sum of squares, hence positive semidefinite.
#pragma once
#include "term_args.h"

typedef struct {
    vec3 weft, warp;          // U and V
    real wu1, wu2, wv1, wv2;  // weights of corners 1 and 2 [1/m]
    real e_uu, e_vv, g;       // strain [1]
    real s_uu, s_vv, s_uv;    // stress [N/m]
    real ku, kv, kc, ks;      // its derivatives: along weft and warp, coupling, shear [N/m]
} membrane_state;

KERNEL_FN membrane_state membrane_strain(int face, const mesh_sizes* size, GLOBAL const real* pos,
                                         GLOBAL const int* face_vertex, GLOBAL const real* face_weights)
{
    int fs = size->face_stride, vs = size->vertex_stride;
    vec3 x0 = load3(pos, vs, face_vertex[face]);
    vec3 d1 = load3(pos, vs, face_vertex[fs + face]) - x0;
    vec3 d2 = load3(pos, vs, face_vertex[2 * fs + face]) - x0;
    membrane_state s;
    s.wu1 = face_weights[face];
    s.wu2 = face_weights[fs + face];
    s.wv1 = face_weights[2 * fs + face];
    s.wv2 = face_weights[3 * fs + face];
    s.weft = s.wu1 * d1 + s.wu2 * d2;
    s.warp = s.wv1 * d1 + s.wv2 * d2;
    s.e_uu = REAL(0.5) * (dot(s.weft, s.weft) - REAL(1));
    s.e_vv = REAL(0.5) * (dot(s.warp, s.warp) - REAL(1));
    s.g = dot(s.weft, s.warp);
    return s;
}

KERNEL_FN void membrane_add_force(int face, real area, const membrane_state* s, GLOBAL real* face_force, int fs)
{
    vec3 p = (-area) * (s->s_uu * s->weft + s->s_uv * s->warp);
    vec3 q = (-area) * (s->s_vv * s->warp + s->s_uv * s->weft);
    vec3 f1 = s->wu1 * p + s->wv1 * q;
    vec3 f2 = s->wu2 * p + s->wv2 * q;
    add3(face_force, fs, face, REAL(-1) * (f1 + f2));
    add3(face_force + 3 * fs, fs, face, f1);
    add3(face_force + 6 * fs, fs, face, f2);
}

// Sets negative tangents to zero and limits the coupling to sqrt(ku kv).
KERNEL_FN void membrane_project_tangents(membrane_state* s)
{
    s->ku = larger(s->ku, REAL(0));
    s->kv = larger(s->kv, REAL(0));
    s->ks = larger(s->ks, REAL(0));
    s->kc = smaller(s->kc, sqrt(s->ku * s->kv));
}

// Sets the negative principal stresses of [s_uu s_uv; s_uv s_vv] to zero, in closed form.
KERNEL_FN void membrane_project_stress(membrane_state* s)
{
    real mean = REAL(0.5) * (s->s_uu + s->s_vv), spread = REAL(0.5) * (s->s_uu - s->s_vv);
    real radius = sqrt(spread * spread + s->s_uv * s->s_uv);
    real high = larger(mean + radius, REAL(0)), low = larger(mean - radius, REAL(0));
    real tilt = (high - low) / larger(REAL(2) * radius, REAL(1e-30));
    s->s_uu = REAL(0.5) * (high + low) + tilt * spread;
    s->s_vv = REAL(0.5) * (high + low) - tilt * spread;
    s->s_uv = tilt * s->s_uv;
}

KERNEL_FN void membrane_add_stiffness(int face, real area, const membrane_state* s, GLOBAL block_real* slots, int fs)
{
    mat3 h_uu = mat3_add(outer3(s->ku, s->weft, s->weft), outer3(s->ks, s->warp, s->warp));
    mat3 h_vv = mat3_add(outer3(s->kv, s->warp, s->warp), outer3(s->ks, s->weft, s->weft));
    mat3 h_uv = mat3_add(outer3(s->kc, s->weft, s->warp), outer3(s->ks, s->warp, s->weft));
    h_uu = mat3_add_diagonal(h_uu, s->s_uu);
    h_vv = mat3_add_diagonal(h_vv, s->s_vv);
    h_uv = mat3_add_diagonal(h_uv, s->s_uv);
    mat3 h_vu = mat3_transpose(h_uv);
    real wu[3], wv[3];
    wu[1] = s->wu1;
    wu[2] = s->wu2;
    wv[1] = s->wv1;
    wv[2] = s->wv2;
    wu[0] = -wu[1] - wu[2];
    wv[0] = -wv[1] - wv[2];
    for (int i = 0; i < 3; ++i)
        for (int j = i + 1; j < 3; ++j) {
            mat3 k = mat3_add(mat3_add(mat3_scale(wu[i] * wu[j], h_uu), mat3_scale(wu[i] * wv[j], h_uv)),
                              mat3_add(mat3_scale(wv[i] * wu[j], h_vu), mat3_scale(wv[i] * wv[j], h_vv)));
            add_block(slots, fs, face, block_index(3, i, j), mat3_scale(area, k));
        }
}
