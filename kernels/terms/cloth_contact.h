// Contact of the cloth with itself, and of its faces and edges with those of bodies: pairs of a vertex and a face, and
// of two edges.
//     r = sum_i w_i x_i  [m]   from the closest point of the second side to that of the first;   d = |r|,  n = r / d
//     s = (d - 0.005 g) / h      h = 0.995 g
//     E = A P h b(s)  [J]       f_i = -w_i A P b'(s) n  [N]       K = A P b''(s) / h n n^T  [N/m]
// g the pair's distance at which contact sets in, P a pressure, A the pair's area, b of barrier.h. No force brings a
// pair nearer than g / 200, so that places rounded to float do not touch either. A corner below zero is a body's: it
// stands at body_point[-1 - corner] and takes no force. Source: Li and others 2021 (C-IPC), with distances in place of
// their squares. K leaves out how n turns: what it leaves out is negative, since f pushes, so that K is the projected
// stiffness at once.
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

// The stage before each of the term's functions: where the closest points are.
KERNEL_FN void pair_frame(int pair, const cloth_contact_args* a)
{
    int ps = a->size.pair_stride;
    vec3 x0 = pair_corner(0, pair, a), x1 = pair_corner(1, pair, a), x2 = pair_corner(2, pair, a),
         x3 = pair_corner(3, pair, a);
    pair_weights p = a->pair_edges[pair] ? closest_edge_edge(x0, x1, x2, x3) : closest_point_face(x0, x1, x2, x3);
    // Differences first: the weights sum to zero, and places far from the origin would cost digits.
    vec3 r = p.w[1] * (x1 - x0) + p.w[2] * (x2 - x0) + p.w[3] * (x3 - x0);
    real d = length(r);
    for (int i = 0; i < 4; ++i) a->pair_weight[i * ps + pair] = p.w[i];
    store3(a->pair_normal, ps, pair, (REAL(1) / larger(d, REAL(1e-30))) * r);
    a->pair_distance[pair] = d;
}

KERNEL_FN real pair_room(int pair, const cloth_contact_args* a) { return REAL(0.995) * a->pair_gap[pair]; }

KERNEL_FN barrier_jet pair_barrier(int pair, const cloth_contact_args* a)
{
    return open_barrier_at((a->pair_distance[pair] - REAL(0.005) * a->pair_gap[pair]) / pair_room(pair, a));
}

KERNEL_FN real cloth_contact_energy(int pair, const cloth_contact_args* a)
{
    return a->pair_area[pair] * a->stiffness * pair_room(pair, a) * pair_barrier(pair, a).value;
}

// How hard the two sides push each other apart [N].
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
    real k = a->pair_area[pair] * a->stiffness / pair_room(pair, a) * pair_barrier(pair, a).curvature;
    add_block(a->pair_stiffness, a->size.pair_stride, pair, 0, outer3(k, n, n));
}
