// Orthotropic membrane with linear stress curves, for scenes in which every fabric is linear: membrane_face.h with
//     s_uu = ku e_uu + kc e_vv,   s_vv = kv e_vv + kc e_uu,   s_uv = ks g       [N/m]
//     E = A/2 (s_uu e_uu + s_vv e_vv + s_uv g)  [J]
// Source: as membrane_face.h. The loop over faces has no branches, so it vectorises: a force costs a quarter of that of
// curved_membrane.h.
#pragma once
#include "../membrane_face.h"

#define membrane_PARAMS(STRENGTH, PARAM) STRENGTH(scale, 0.0, "1", "multiplies every membrane stiffness")
// clang-format off
#define membrane_FIELDS(READ, ADD)                                                             \
    READ(pos) READ(face_vertex) READ(face_material) READ(face_area) READ(face_weights)          \
    READ(material_stretch) ADD(face_force) ADD(face_stiffness)
// clang-format on
TERM_ARGS(membrane)

KERNEL_FN membrane_state membrane_at(int face, const membrane_args* a)
{
    membrane_state s = membrane_strain(face, &a->size, a->pos, a->face_vertex, a->face_weights);
    int ms = a->size.material_stride, material = a->face_material[face];
    s.ku = a->scale * a->material_stretch[material];
    s.kv = a->scale * a->material_stretch[ms + material];
    s.kc = a->scale * a->material_stretch[2 * ms + material];
    s.ks = a->scale * a->material_stretch[3 * ms + material];
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
    membrane_state s = membrane_at(face, a);
    membrane_add_force(face, a->face_area[face], &s, a->face_force, a->size.face_stride);
}

KERNEL_FN void membrane_stiffness(int face, const membrane_args* a)
{
    membrane_state s = membrane_at(face, a);
    if (a->mode.projected) membrane_project_stress(&s);
    membrane_add_stiffness(face, a->face_area[face], &s, a->face_stiffness, a->size.face_stride);
}
