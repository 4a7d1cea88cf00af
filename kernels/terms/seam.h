// Seam force: pulls the two vertices of a stitch together; d = x1 - x0, l = |d|.
//     l <= F/k:  E = k/2 l^2,          f0 =  k d                    (a linear spring)
//     l >  F/k:  E = F (l - F/(2k)),   f0 =  F d / l                (a constant force while the panels are far apart)
// Source: Fan, Zhou, Wang and Yuen 1998 for the spring. The limit F is added so that panels that start far apart are
// drawn in at a speed that does not depend on their distance.
#pragma once
#include "../term_args.h"

#define seam_PARAMS(STRENGTH, PARAM)                                           \
    STRENGTH(stiffness, 0.0, "N/m", "seam force per pair and metre of gap, k") \
    PARAM(force_limit, 0.2, "N", "largest force on a pair, F")
#define seam_FIELDS(READ, ADD) READ(pos) READ(stitch_vertex) ADD(stitch_force) ADD(stitch_stiffness)
TERM_ARGS(seam)

KERNEL_FN vec3 seam_gap(int stitch, const seam_args* a)
{
    int v0 = a->stitch_vertex[stitch], v1 = a->stitch_vertex[a->size.stitch_stride + stitch];
    return load3(a->pos, a->size.vertex_stride, v1) - load3(a->pos, a->size.vertex_stride, v0);
}

KERNEL_FN real seam_energy(int stitch, const seam_args* a)
{
    real l = length(seam_gap(stitch, a)), reach = a->force_limit / a->stiffness;
    if (l <= reach) return REAL(0.5) * a->stiffness * l * l;
    return a->force_limit * (l - REAL(0.5) * reach);
}

KERNEL_FN void seam_force(int stitch, const seam_args* a)
{
    int ss = a->size.stitch_stride;
    vec3 d = seam_gap(stitch, a);
    real l = length(d);
    vec3 f0 = (l * a->stiffness <= a->force_limit ? a->stiffness : a->force_limit / l) * d;
    add3(a->stitch_force, ss, stitch, f0);
    add3(a->stitch_force + 3 * ss, ss, stitch, REAL(-1) * f0);
}

KERNEL_FN void seam_stiffness(int stitch, const seam_args* a)
{
    int ss = a->size.stitch_stride;
    vec3 d = seam_gap(stitch, a);
    real l = length(d);
    int near = l * a->stiffness <= a->force_limit;
    real k = near ? a->stiffness : a->force_limit / l;
    mat3 m = outer3(near ? REAL(0) : -k / (l * l), d, d);
    m = mat3_add_diagonal(m, k);
    add_block(a->stitch_stiffness, ss, stitch, block_index(2, 0, 1), mat3_scale(REAL(-1), m));
}
