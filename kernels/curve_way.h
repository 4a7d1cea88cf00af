// The stretch of second order on a straight way. A stiff sheet that turns follows a curved way: along its tangent d,
//     e(x + s d) = e(x) + s De d + s^2 e'',   e'' = (|U(d)|^2/2, |V(d)|^2/2, U(d).V(d))     (see membrane_face.h)
// and e'' outweighs what the way gains. Its force, with tangents k of the stress at x,
//     f_j = -A (k e'') : de/dx_j,
// is the right side of H c = f, whose solution bends the way to x + s d + s^2 c and leaves stretch of third order only.
// Source: geodesic acceleration, Transtrum and Sethna 2012; the second-order correction that keeps curved constraints,
// Fletcher 1982.
#pragma once
#include "membrane_face.h"
#include "stress_curve.h"

typedef struct {
    mesh_sizes size;
    GLOBAL const real* RESTRICT pos;
    GLOBAL const real* RESTRICT direction;
    GLOBAL const int* RESTRICT face_vertex;
    GLOBAL const int* RESTRICT face_material;
    GLOBAL const real* RESTRICT face_area;
    GLOBAL const real* RESTRICT face_weights;
    GLOBAL const real* RESTRICT material_stretch;
    GLOBAL const real* RESTRICT material_curve;  // null where every fabric is linear
    GLOBAL real* RESTRICT face_force;
    real scale;  // multiplies every membrane stiffness
} curve_way_args;

// Adds the force to the face's slots; returns the energy of e'' alone, A/2 e''.k e'' [J].
KERNEL_FN real curve_way(int face, const curve_way_args* a)
{
    membrane_state s = membrane_strain(face, &a->size, a->pos, a->face_vertex, a->face_weights);
    membrane_state d = membrane_strain(face, &a->size, a->direction, a->face_vertex, a->face_weights);
    real uu = d.e_uu + REAL(0.5), vv = d.e_vv + REAL(0.5), uv = d.g;
    int ms = a->size.material_stride, material = a->face_material[face];
    s.ku = a->material_stretch[material];
    s.kv = a->material_stretch[ms + material];
    s.kc = a->material_stretch[2 * ms + material];
    s.ks = a->material_stretch[3 * ms + material];
    if (a->material_curve) {
        GLOBAL const real* curves = a->material_curve + material;
        s.ku = curve_at(curves, ms, s.e_uu).tangent;
        s.kv = curve_at(curves + CURVE_NUMBERS * CURVE_RANGES * ms, ms, s.e_vv).tangent;
        s.ks = odd_curve_at(curves + 2 * CURVE_NUMBERS * CURVE_RANGES * ms, ms, s.g).tangent;
    }
    s.s_uu = a->scale * (s.ku * uu + s.kc * vv);
    s.s_vv = a->scale * (s.kv * vv + s.kc * uu);
    s.s_uv = a->scale * s.ks * uv;
    membrane_add_force(face, a->face_area[face], &s, a->face_force, a->size.face_stride);
    return REAL(0.5) * a->face_area[face] * (s.s_uu * uu + s.s_vv * vv + s.s_uv * uv);
}

typedef struct {
    GLOBAL real* RESTRICT way;
    GLOBAL const real* RESTRICT straight;
    GLOBAL const real* RESTRICT curve;
    real part;
} part_of_way_args;

// The part of a bent way from its start on: s d + s^2 c.
KERNEL_FN void part_of_way(int i, const part_of_way_args* a)
{
    a->way[i] = a->part * (a->straight[i] + a->part * a->curve[i]);
}
