// Finds which way the faces lie to the air: the vector area of each, whose direction is the normal.
//     a = 1/2 (x1 - x0) x (x2 - x0)  [m^2]
// Source: see terms/wind.h.
#pragma once
#include "../term_args.h"

#define face_air_FIELDS(READ, ADD) READ(pos) READ(face_vertex) ADD(face_air)

typedef struct {
    mesh_sizes size;
    face_air_FIELDS(ARG_READ, ARG_ADD)
} face_air_args;

KERNEL_FN void face_air_of(int face, const face_air_args* a)
{
    int fs = a->size.face_stride, vs = a->size.vertex_stride;
    vec3 x0 = load3(a->pos, vs, a->face_vertex[face]);
    vec3 d1 = load3(a->pos, vs, a->face_vertex[fs + face]) - x0;
    vec3 d2 = load3(a->pos, vs, a->face_vertex[2 * fs + face]) - x0;
    store3(a->face_air, fs, face, REAL(0.5) * cross(d1, d2));
}
