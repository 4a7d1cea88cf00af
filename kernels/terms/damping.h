// Viscous drag on every vertex, proportional to its mass.
//     R = 1/2 c |v|^2  [W]        f = -c v  [N]        -df/dv = c I,    c = drag coefficient [kg/s]
// Source: Fan, Zhou, Wang and Yuen 1998.
#pragma once
#include "../term_args.h"

#define damping_PARAMS(STRENGTH, PARAM) STRENGTH(scale, 0.0, "1", "multiplies every fabric's damping")
#define damping_FIELDS(READ, ADD) READ(vel) READ(drag) ADD(force) ADD(vertex_stiffness)
TERM_ARGS(damping)

KERNEL_FN real damping_energy(int vertex, const damping_args* a)
{
    vec3 v = load3(a->vel, a->size.vertex_stride, vertex);
    return REAL(0.5) * a->scale * a->drag[vertex] * dot(v, v);
}

KERNEL_FN void damping_force(int vertex, const damping_args* a)
{
    vec3 v = load3(a->vel, a->size.vertex_stride, vertex);
    add3(a->force, a->size.vertex_stride, vertex, (-a->scale * a->drag[vertex]) * v);
}

KERNEL_FN void damping_stiffness(int vertex, const damping_args* a)
{
    real c = a->scale * a->drag[vertex];
    mat3 zero = outer3(REAL(0), make_vec3(0, 0, 0), make_vec3(0, 0, 0));
    add_block(a->vertex_stiffness, a->size.vertex_stride, vertex, 0, mat3_add_diagonal(zero, c));
}
