// Gravity: a uniform field acting on lumped masses.
//     E = -m a . x  [J]        f = m a  [N]        no stiffness
// Source: Fan, Zhou, Wang and Yuen 1998, with the mass lumped by area instead of by particle count.
#pragma once
#include "../term_args.h"

#define gravity_PARAMS(STRENGTH, PARAM)                            \
    STRENGTH(acceleration_x, 0.0, "m/s^2", "acceleration along x") \
    STRENGTH(acceleration_y, 0.0, "m/s^2", "acceleration along y") \
    STRENGTH(acceleration_z, 0.0, "m/s^2", "acceleration along z")
#define gravity_FIELDS(READ, ADD) READ(pos) READ(mass) ADD(force)
TERM_ARGS(gravity)

KERNEL_FN vec3 gravity_weight(int vertex, const gravity_args* a)
{
    return a->mass[vertex] * make_vec3(a->acceleration_x, a->acceleration_y, a->acceleration_z);
}

KERNEL_FN real gravity_energy(int vertex, const gravity_args* a)
{
    return -dot(gravity_weight(vertex, a), load3(a->pos, a->size.vertex_stride, vertex));
}

KERNEL_FN void gravity_force(int vertex, const gravity_args* a)
{
    add3(a->force, a->size.vertex_stride, vertex, gravity_weight(vertex, a));
}

KERNEL_FN void gravity_stiffness(int vertex, const gravity_args* a)
{
    (void)vertex;
    (void)a;
}
