// Barrier contact of the cloth with itself, and of its faces and edges with those of bodies. A pair is a vertex and a
// face, or two edges.
//     r = sum_i w_i x_i  [m]   from the closest point of the second side to that of the first;   d = |r|,  n = r / d
//     s = (d - 0.005 g) / h      h = 0.995 g
//     E = A P h b(s)  [J]       f_i = -w_i A P b'(s) n  [N]       K = A P b''(s) / h n n^T  [N/m]
// g is the distance at which the pair's contact sets in, P a pressure, A the pair's area, b the barrier of barrier.h.
// The barrier is infinite at d = g / 200, so that pairs do not touch in output files either, where positions are
// rounded to a micrometre. A negative corner belongs to a body: its position is body_point[-1 - corner], and it takes
// no force. A vertex beyond the rim of a layer meets the plane of the face there, as ContactPairs tells.
// K omits the change of n. The omitted part is negative semidefinite, because f is repulsive, so K is already the
// projected stiffness.
// Source: Li and others 2021 (C-IPC), with distances in place of squared distances.
#pragma once
#include "../barrier.h"
#include "../closest.h"
#include "../term_args.h"

#define cloth_contact_PARAMS(STRENGTH, PARAM)                          \
    STRENGTH(stiffness, 0.0, "Pa", "pressure scale of the barrier, P") \
    PARAM(gap, 0.002, "m", "distance at which contact of cloth with cloth sets in")
// clang-format off
#define cloth_contact_FIELDS(READ, ADD)                                                            \
    READ(pos) READ(body_point) READ(pair_vertex) READ(pair_edges) READ(pair_area) READ(pair_gap)   \
    ADD(pair_weight) ADD(pair_normal) ADD(pair_distance) ADD(pair_force) ADD(pair_stiffness) ADD(vertex_stiffness)
// clang-format on
TERM_ARGS(cloth_contact)

KERNEL_FN vec3 pair_corner(int corner, int pair, const cloth_contact_args* a)
{
    int v = a->pair_vertex[corner * a->size.pair_stride + pair];
    return v >= 0 ? load3(a->pos, a->size.vertex_stride, v) : load3(a->body_point, a->size.body_point_stride, -1 - v);
}

// The stage that runs before each function of the term: finds the closest points, the normal and the distance.
KERNEL_FN void pair_frame(int pair, const cloth_contact_args* a)
{
    int ps = a->size.pair_stride;
    vec3 x0 = pair_corner(0, pair, a), x1 = pair_corner(1, pair, a), x2 = pair_corner(2, pair, a),
         x3 = pair_corner(3, pair, a);
    int kind = a->pair_edges[pair];
    pair_weights p = kind == 1   ? closest_edge_edge(x0, x1, x2, x3)
                     : kind == 2 ? closest_point_plane(x0, x1, x2, x3)
                                 : closest_point_face(x0, x1, x2, x3);
    // The weights sum to zero, so r is a sum of differences of positions. Taking the differences first avoids the
    // cancellation that positions far from the origin would cause.
    vec3 r = p.w[1] * (x1 - x0) + p.w[2] * (x2 - x0) + p.w[3] * (x3 - x0);
    real d = length(r);
    for (int i = 0; i < 4; ++i) a->pair_weight[i * ps + pair] = p.w[i];
    store3(a->pair_normal, ps, pair, (REAL(1) / larger(d, REAL(1e-30))) * r);
    a->pair_distance[pair] = d;
}

// The width h of the barrier: from g / 200, where it is infinite, to g, where contact sets in [m].
KERNEL_FN real pair_barrier_width(int pair, const cloth_contact_args* a) { return REAL(0.995) * a->pair_gap[pair]; }

KERNEL_FN barrier_jet pair_barrier(int pair, const cloth_contact_args* a)
{
    return open_barrier_at((a->pair_distance[pair] - REAL(0.005) * a->pair_gap[pair]) / pair_barrier_width(pair, a));
}

KERNEL_FN real cloth_contact_energy(int pair, const cloth_contact_args* a)
{
    return a->pair_area[pair] * a->stiffness * pair_barrier_width(pair, a) * pair_barrier(pair, a).value;
}

// Normal force, positive when the sides push each other apart [N].
KERNEL_FN real cloth_contact_push(int pair, const cloth_contact_args* a)
{
    return -a->pair_area[pair] * a->stiffness * pair_barrier(pair, a).slope;
}

KERNEL_FN void cloth_contact_force(int pair, const cloth_contact_args* a)
{
    int ps = a->size.pair_stride;
    vec3 push = cloth_contact_push(pair, a) * load3(a->pair_normal, ps, pair);
    for (int i = 0; i < 4; ++i) add3(a->pair_force + 3 * i * ps, ps, pair, a->pair_weight[i * ps + pair] * push);
}

KERNEL_FN void cloth_contact_stiffness(int pair, const cloth_contact_args* a)
{
    vec3 n = load3(a->pair_normal, a->size.pair_stride, pair);
    real k = a->pair_area[pair] * a->stiffness / pair_barrier_width(pair, a) * pair_barrier(pair, a).curvature;
    add_block(a->pair_stiffness, a->size.pair_stride, pair, 0, outer3(k, n, n));
}
