// Orthotropic membrane with measured stress curves. It replaces membrane.h in scenes where a fabric has a curve or an
// over-elongation limit.
//     s_uu = s_u(e_uu) + kc e_vv,   s_vv = s_v(e_vv) + kc e_uu,   s_uv = s_s(g)       [N/m]
//     E = A (W_u(e_uu) + W_v(e_vv) + W_s(g) + kc e_uu e_vv),   W the integrals of the curves s_u, s_v, s_s   [J]
// Shear is odd in g. In compression the curves continue with their slopes at zero.
// Source: Volino, Magnenat-Thalmann and Faure 2009, section 4; stress_curve.h for curves and over-elongation limits.
#pragma once
#include "../membrane_face.h"
#include "../stress_curve.h"

#define curved_membrane_PARAMS(STRENGTH, PARAM) STRENGTH(scale, 0.0, "1", "multiplies every membrane stress")
// clang-format off
#define curved_membrane_FIELDS(READ, ADD)                                                      \
    READ(pos) READ(face_vertex) READ(face_material) READ(face_area) READ(face_weights)          \
    READ(material_stretch) READ(material_curve) ADD(face_force) ADD(face_stiffness)
// clang-format on
TERM_ARGS(curved_membrane)

typedef struct {
    membrane_state membrane;
    real energy;  // per rest area [J/m^2]
} curved_membrane_state;

KERNEL_FN curved_membrane_state curved_membrane_at(int face, const curved_membrane_args* a)
{
    membrane_state s = membrane_strain(face, &a->size, a->pos, a->face_vertex, a->face_weights);
    int ms = a->size.material_stride, material = a->face_material[face];
    GLOBAL const real* curves = a->material_curve + material;
    curve_value u = curve_at(curves, ms, s.e_uu);
    curve_value v = curve_at(curves + CURVE_NUMBERS * CURVE_RANGES * ms, ms, s.e_vv);
    curve_value shear = odd_curve_at(curves + 2 * CURVE_NUMBERS * CURVE_RANGES * ms, ms, s.g);
    s.kc = a->scale * a->material_stretch[2 * ms + material];
    s.ku = a->scale * u.tangent;
    s.kv = a->scale * v.tangent;
    s.ks = a->scale * shear.tangent;
    s.s_uu = a->scale * u.stress + s.kc * s.e_vv;
    s.s_vv = a->scale * v.stress + s.kc * s.e_uu;
    s.s_uv = a->scale * shear.stress;
    curved_membrane_state state;
    state.energy = a->scale * (u.energy + v.energy + shear.energy) + s.kc * s.e_uu * s.e_vv;
    state.membrane = s;
    return state;
}

KERNEL_FN real curved_membrane_energy(int face, const curved_membrane_args* a)
{
    return a->face_area[face] * curved_membrane_at(face, a).energy;
}

KERNEL_FN void curved_membrane_force(int face, const curved_membrane_args* a)
{
    curved_membrane_state s = curved_membrane_at(face, a);
    membrane_add_force(face, a->face_area[face], &s.membrane, a->face_force, a->size.face_stride);
}

KERNEL_FN void curved_membrane_stiffness(int face, const curved_membrane_args* a)
{
    curved_membrane_state s = curved_membrane_at(face, a);
    if (a->mode.projected) {
        membrane_project_tangents(&s.membrane);
        membrane_project_stress(&s.membrane);
    }
    membrane_add_stiffness(face, a->face_area[face], &s.membrane, a->face_stiffness, a->size.face_stride);
}
