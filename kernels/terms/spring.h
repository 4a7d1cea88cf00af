// Structural, shear and bend springs and elastic between two vertices, each with an over-elongation limit.
//     l = |x1 - x0|,   T = k (l - l0) up to the length L, beyond it k (L - l0) + k_L (l - L)      [N]
//     E = integral of T dl,   f_0 = T n = -f_1,   n = (x1 - x0) / l
//     d2E/dx2: blocks +-(k n n^T + T/l (I - n n^T))
// Source: Fan, Zhou, Wang and Yuen 1998, also for the piecewise linear law with one constant per range; the limit is
// that of the cuboid mass-spring model of weft-knitted fabric by Sha, Jiang, Ma and Li.
// In compression (T < 0) the part T/l (I - n n^T) is negative, so the projected stiffness drops it.
#pragma once
#include "../term_args.h"

#define spring_PARAMS(STRENGTH, PARAM)                                                    \
    STRENGTH(scale, 0.0, "1", "multiplies the constants of structural and shear springs") \
    STRENGTH(bend_scale, 0.0, "1", "multiplies the constants of bend springs")            \
    STRENGTH(elastic_scale, 0.0, "1", "multiplies the constants of elastic")
// clang-format off
#define spring_FIELDS(READ, ADD)                                                                     \
    READ(pos) READ(spring_vertex) READ(spring_length) READ(spring_constant) READ(spring_limit)       \
    READ(spring_kind) ADD(spring_force) ADD(spring_stiffness)
// clang-format on
TERM_ARGS(spring)

typedef struct {
    vec3 n;                  // from vertex 0 to vertex 1, unit
    real length, extension;  // l and l - l0 [m]
    real over;               // l - L beyond the limit, else 0 [m]
    real k, k_over;          // k and k_L - k [N/m]
    real tension;            // T [N]
} spring_state;

KERNEL_FN spring_state spring_at(int spring, const spring_args* a)
{
    int ss = a->size.spring_stride, vs = a->size.vertex_stride;
    vec3 d = load3(a->pos, vs, a->spring_vertex[ss + spring]) - load3(a->pos, vs, a->spring_vertex[spring]);
    int kind = a->spring_kind[spring];
    real scale = kind == 2 ? a->elastic_scale : kind == 1 ? a->bend_scale : a->scale;
    spring_state s;
    s.length = larger(length(d), REAL(1e-12));  // coincident vertices have no direction: n = 0, and so no force
    s.n = (REAL(1) / s.length) * d;
    s.extension = s.length - a->spring_length[spring];
    s.over = larger(s.length - a->spring_limit[spring], REAL(0));
    s.k = scale * a->spring_constant[spring];
    s.k_over = scale * a->spring_constant[ss + spring] - s.k;
    s.tension = s.k * s.extension + s.k_over * s.over;
    return s;
}

KERNEL_FN real spring_energy(int spring, const spring_args* a)
{
    spring_state s = spring_at(spring, a);
    return REAL(0.5) * (s.k * s.extension * s.extension + s.k_over * s.over * s.over);
}

KERNEL_FN void spring_force(int spring, const spring_args* a)
{
    int ss = a->size.spring_stride;
    spring_state s = spring_at(spring, a);
    add3(a->spring_force, ss, spring, s.tension * s.n);
    add3(a->spring_force + 3 * ss, ss, spring, (-s.tension) * s.n);
}

KERNEL_FN void spring_stiffness(int spring, const spring_args* a)
{
    spring_state s = spring_at(spring, a);
    real across = s.tension / s.length;
    if (a->mode.projected) across = larger(across, REAL(0));
    real along = s.k + (s.over > REAL(0) ? s.k_over : REAL(0)) - across;
    add_block(a->spring_stiffness, a->size.spring_stride, spring, 0,
              mat3_add_diagonal(outer3(-along, s.n, s.n), -across));
}
