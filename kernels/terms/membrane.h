// Orthotropic membrane: one constant-strain triangle per face, in the fabric's weft (u) and warp (v) directions.
//     U = sum_j wu_j x_j,   V = sum_j wv_j x_j                     (deformed weft and warp directions)
//     e_uu = (U.U - 1)/2,   e_vv = (V.V - 1)/2,   g = U.V          (Green-Lagrange; g is twice the tensor's shear)
//     s_uu = ku e_uu + kc e_vv,   s_vv = kv e_vv + kc e_uu,   s_uv = ks g       [N/m]
//     E = A/2 (s_uu e_uu + s_vv e_vv + s_uv g)  [J]
//     f_j = -A (s_uu wu_j U + s_vv wv_j V + s_uv (wu_j V + wv_j U))  [N]
// The weights are constant: sum w = 0, sum wu u = 1, sum wu v = 0 (and the reverse for wv).
// Source: Volino, Magnenat-Thalmann and Faure 2009, eqs. 1-12, as restated in D5 and D6.
// The projected stiffness keeps the tensile part of the stress only (negative principal stresses are cut), which
// makes each element matrix positive semi-definite since the material part is a sum of squares.
#pragma once
#include "../term_args.h"

#define membrane_PARAMS(STRENGTH, PARAM) STRENGTH(scale, 0.0, "1", "multiplies every membrane stiffness")
#define membrane_FIELDS(READ, ADD)                                                             \
    READ(pos) READ(face_vertex) READ(face_material) READ(face_area) READ(face_weights)          \
    READ(material_stretch) ADD(face_force) ADD(face_stiffness)
TERM_ARGS(membrane)

typedef struct {
    vec3 weft, warp;             // U and V
    real ku, kv, kc, ks;         // stiffness [N/m]
    real e_uu, e_vv, g;          // strain [1]
    real s_uu, s_vv, s_uv;       // stress [N/m]
} membrane_state;

KERNEL_FN membrane_state membrane_at(int face, const membrane_args* a)
{
    int fs = a->size.face_stride, vs = a->size.vertex_stride, ms = a->size.material_stride;
    vec3 x0 = load3(a->pos, vs, a->face_vertex[face]);
    vec3 d1 = load3(a->pos, vs, a->face_vertex[fs + face]) - x0;
    vec3 d2 = load3(a->pos, vs, a->face_vertex[2 * fs + face]) - x0;
    int material = a->face_material[face];
    membrane_state s;
    s.weft = a->face_weights[face] * d1 + a->face_weights[fs + face] * d2;
    s.warp = a->face_weights[2 * fs + face] * d1 + a->face_weights[3 * fs + face] * d2;
    s.ku = a->scale * a->material_stretch[material];
    s.kv = a->scale * a->material_stretch[ms + material];
    s.kc = a->scale * a->material_stretch[2 * ms + material];
    s.ks = a->scale * a->material_stretch[3 * ms + material];
    s.e_uu = REAL(0.5) * (dot(s.weft, s.weft) - REAL(1));
    s.e_vv = REAL(0.5) * (dot(s.warp, s.warp) - REAL(1));
    s.g = dot(s.weft, s.warp);
    s.s_uu = s.ku * s.e_uu + s.kc * s.e_vv;
    s.s_vv = s.kv * s.e_vv + s.kc * s.e_uu;
    s.s_uv = s.ks * s.g;
    return s;
}

KERNEL_FN real membrane_energy(int face, const membrane_args* a)
{
    membrane_state s = membrane_at(face, a);
    return REAL(0.5) * a->face_area[face] * (s.s_uu * s.e_uu + s.s_vv * s.e_vv + s.s_uv * s.g);
}

KERNEL_FN void membrane_force(int face, const membrane_args* a)
{
    int fs = a->size.face_stride;
    membrane_state s = membrane_at(face, a);
    vec3 p = (-a->face_area[face]) * (s.s_uu * s.weft + s.s_uv * s.warp);
    vec3 q = (-a->face_area[face]) * (s.s_vv * s.warp + s.s_uv * s.weft);
    vec3 f1 = a->face_weights[face] * p + a->face_weights[2 * fs + face] * q;
    vec3 f2 = a->face_weights[fs + face] * p + a->face_weights[3 * fs + face] * q;
    add3(a->face_force, fs, face, REAL(-1) * (f1 + f2));
    add3(a->face_force + 3 * fs, fs, face, f1);
    add3(a->face_force + 6 * fs, fs, face, f2);
}

// Cuts the negative principal stresses of [s_uu s_uv; s_uv s_vv] in closed form.
KERNEL_FN void membrane_project_stress(membrane_state* s)
{
    real mean = REAL(0.5) * (s->s_uu + s->s_vv), spread = REAL(0.5) * (s->s_uu - s->s_vv);
    real radius = sqrt(spread * spread + s->s_uv * s->s_uv);
    real high = fmax(mean + radius, REAL(0)), low = fmax(mean - radius, REAL(0));
    real tilt = (high - low) / fmax(REAL(2) * radius, REAL(1e-30));
    s->s_uu = REAL(0.5) * (high + low) + tilt * spread;
    s->s_vv = REAL(0.5) * (high + low) - tilt * spread;
    s->s_uv = tilt * s->s_uv;
}

KERNEL_FN void membrane_stiffness(int face, const membrane_args* a)
{
    int fs = a->size.face_stride;
    membrane_state s = membrane_at(face, a);
    if (a->mode.projected) membrane_project_stress(&s);
    real area = a->face_area[face];
    mat3 h_uu = mat3_add(outer3(s.ku, s.weft, s.weft), outer3(s.ks, s.warp, s.warp));
    mat3 h_vv = mat3_add(outer3(s.kv, s.warp, s.warp), outer3(s.ks, s.weft, s.weft));
    mat3 h_uv = mat3_add(outer3(s.kc, s.weft, s.warp), outer3(s.ks, s.warp, s.weft));
    h_uu = mat3_add_diagonal(h_uu, s.s_uu);
    h_vv = mat3_add_diagonal(h_vv, s.s_vv);
    h_uv = mat3_add_diagonal(h_uv, s.s_uv);
    mat3 h_vu = mat3_transpose(h_uv);
    real wu[3], wv[3];
    wu[1] = a->face_weights[face];
    wu[2] = a->face_weights[fs + face];
    wv[1] = a->face_weights[2 * fs + face];
    wv[2] = a->face_weights[3 * fs + face];
    wu[0] = -wu[1] - wu[2];
    wv[0] = -wv[1] - wv[2];
    for (int i = 0; i < 3; ++i)
        for (int j = i + 1; j < 3; ++j) {
            mat3 k = mat3_add(mat3_add(mat3_scale(wu[i] * wu[j], h_uu), mat3_scale(wu[i] * wv[j], h_uv)),
                              mat3_add(mat3_scale(wv[i] * wu[j], h_vu), mat3_scale(wv[i] * wv[j], h_vv)));
            add_block(a->face_stiffness, fs, face, block_index(3, i, j), mat3_scale(area, k));
        }
}
