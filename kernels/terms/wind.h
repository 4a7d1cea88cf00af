// Air on cloth. Each face answers the air that streams past it, u = v_air - v, by itself, as a flat plate does:
//     F / A = 1/2 (N |u_n| u_n + T |u_t| u_t)  [Pa],   u_n along the face's normal, u_t in its plane
// N and T are the air's density times the coefficients along the normal and in the plane [kg/m^3]. On a face that is
// inclined to the stream the part along the normal is drag and lift at once. The pressure has the potential
//     r(u) = 1/6 (N |u_n|^3 + T |u_t|^3)  [W/m^2],   F / A = dr/du
// which is convex. A face's integral is lumped at its corners, as its mass is. Two terms share the law:
//     wind      the load on cloth at rest:      f0 = A dr/du(v_air),    E = -f0 . x
//     air_drag  what motion adds to that load:  R(v) = A (r(v_air - v) - r(v_air) + v . dr/du(v_air)),   f = -dR/dv
// R is convex and least at v = 0: drag takes energy from the cloth, and the matrix of d2R/dv2 has no negative
// eigenvalue. Normals and areas stay as stages/face_air.h last found them while an iteration is solved, since a load
// that turns with the cloth has no potential; the iterations of a step bring them to its end.
// Source: the law of the normal part is that of a plate across a stream (Hoerner 1965, ch. 3); that each element
// answers by itself is the usual simplification of cloth in wind (Ling, Damodaran and Gay 1996 discuss it).
#pragma once
#include "../term_args.h"

// clang-format off
#define AIR_PARAMS(STRENGTH, PARAM)                                                                        \
    STRENGTH(normal, 0.0, "kg/m^3", "density of the air times the coefficient along a face's normal, N")   \
    STRENGTH(tangential, 0.0, "kg/m^3", "density of the air times the coefficient in a face's plane, T")   \
    PARAM(velocity_x, 0.0, "m/s", "velocity of the air along x")                                           \
    PARAM(velocity_y, 0.0, "m/s", "velocity of the air along y")                                           \
    PARAM(velocity_z, 0.0, "m/s", "velocity of the air along z")
#define AIR_FIELDS(READ) READ(face_vertex) READ(face_slots) READ(face_slot) READ(face_air)
// clang-format on
#define wind_PARAMS(STRENGTH, PARAM) AIR_PARAMS(STRENGTH, PARAM)
#define wind_FIELDS(READ, ADD) AIR_FIELDS(READ) READ(pos) ADD(force)
TERM_ARGS(wind)
#define air_drag_PARAMS(STRENGTH, PARAM) AIR_PARAMS(STRENGTH, PARAM)
#define air_drag_FIELDS(READ, ADD) AIR_FIELDS(READ) READ(vel) ADD(force) ADD(vertex_stiffness)
TERM_ARGS(air_drag)

// What streams past a face: u, split by the face's normal.
typedef struct {
    vec3 n;         // unit normal
    vec3 along;     // u_t [m/s]
    real across;    // u_n [m/s]
    real slipping;  // |u_t| [m/s]
} air_stream;

KERNEL_FN air_stream stream_past(vec3 u, vec3 n)
{
    air_stream s;
    s.n = n;
    s.across = dot(u, n);
    s.along = u - s.across * n;
    s.slipping = length(s.along);
    return s;
}

KERNEL_FN real air_potential(const air_stream* s, real normal, real tangential)
{
    real across = fabs(s->across);
    return (normal * across * across * across + tangential * s->slipping * s->slipping * s->slipping) / REAL(6);
}

KERNEL_FN vec3 air_pressure(const air_stream* s, real normal, real tangential)
{
    return (REAL(0.5) * normal * fabs(s->across) * s->across) * s->n +
           (REAL(0.5) * tangential * s->slipping) * s->along;
}

// d2r/du2
KERNEL_FN mat3 air_slope(const air_stream* s, real normal, real tangential)
{
    real t = REAL(0.5) * tangential, slipping = larger(s->slipping, REAL(1e-30));
    mat3 m = outer3(normal * fabs(s->across) - t * s->slipping, s->n, s->n);
    m = mat3_add_diagonal(m, t * s->slipping);
    return mat3_add(m, outer3(t / slipping, s->along, s->along));
}

// The vector area [m^2] that a corner of a face stands for, and its size.
KERNEL_FN vec3 corner_area(int face, int face_stride, GLOBAL const real* face_air, real* area)
{
    vec3 share = (REAL(1) / REAL(3)) * load3(face_air, face_stride, face);
    *area = length(share);
    return (REAL(1) / larger(*area, REAL(1e-30))) * share;
}

KERNEL_FN vec3 wind_load(int vertex, const wind_args* a)
{
    int vs = a->size.vertex_stride, end = a->face_slots[vs + vertex];
    vec3 air = make_vec3(a->velocity_x, a->velocity_y, a->velocity_z), load = make_vec3(0, 0, 0);
    for (int slot = a->face_slots[vertex]; slot < end; ++slot) {
        real area;
        vec3 n = corner_area(a->face_slot[slot] / 4, a->size.face_stride, a->face_air, &area);
        air_stream past = stream_past(air, n);
        load = load + area * air_pressure(&past, a->normal, a->tangential);
    }
    return load;
}

KERNEL_FN real wind_energy(int vertex, const wind_args* a)
{
    return -dot(wind_load(vertex, a), load3(a->pos, a->size.vertex_stride, vertex));
}

KERNEL_FN void wind_force(int vertex, const wind_args* a)
{
    add3(a->force, a->size.vertex_stride, vertex, wind_load(vertex, a));
}

KERNEL_FN void wind_stiffness(int vertex, const wind_args* a)
{
    (void)vertex;
    (void)a;
}

KERNEL_FN real air_drag_energy(int vertex, const air_drag_args* a)
{
    int vs = a->size.vertex_stride, end = a->face_slots[vs + vertex];
    vec3 air = make_vec3(a->velocity_x, a->velocity_y, a->velocity_z), v = load3(a->vel, vs, vertex);
    real total = 0;
    for (int slot = a->face_slots[vertex]; slot < end; ++slot) {
        real area;
        vec3 n = corner_area(a->face_slot[slot] / 4, a->size.face_stride, a->face_air, &area);
        air_stream past = stream_past(air - v, n), at_rest = stream_past(air, n);
        vec3 load = air_pressure(&at_rest, a->normal, a->tangential);
        total += area * (air_potential(&past, a->normal, a->tangential) -
                         air_potential(&at_rest, a->normal, a->tangential) + dot(v, load));
    }
    return total;
}

KERNEL_FN void air_drag_force(int vertex, const air_drag_args* a)
{
    int vs = a->size.vertex_stride, end = a->face_slots[vs + vertex];
    vec3 air = make_vec3(a->velocity_x, a->velocity_y, a->velocity_z), v = load3(a->vel, vs, vertex);
    vec3 drag = make_vec3(0, 0, 0);
    for (int slot = a->face_slots[vertex]; slot < end; ++slot) {
        real area;
        vec3 n = corner_area(a->face_slot[slot] / 4, a->size.face_stride, a->face_air, &area);
        air_stream past = stream_past(air - v, n), at_rest = stream_past(air, n);
        drag = drag + area * (air_pressure(&past, a->normal, a->tangential) -
                              air_pressure(&at_rest, a->normal, a->tangential));
    }
    add3(a->force, vs, vertex, drag);
}

KERNEL_FN void air_drag_stiffness(int vertex, const air_drag_args* a)
{
    int vs = a->size.vertex_stride, end = a->face_slots[vs + vertex];
    vec3 air = make_vec3(a->velocity_x, a->velocity_y, a->velocity_z), v = load3(a->vel, vs, vertex);
    for (int slot = a->face_slots[vertex]; slot < end; ++slot) {
        real area;
        vec3 n = corner_area(a->face_slot[slot] / 4, a->size.face_stride, a->face_air, &area);
        air_stream past = stream_past(air - v, n);
        add_block(a->vertex_stiffness, vs, vertex, 0, mat3_scale(area, air_slope(&past, a->normal, a->tangential)));
    }
}
