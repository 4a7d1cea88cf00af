// Exponential repulsion of the cloth from itself, and of its faces and edges from those of bodies, in pairs.
//     E = A P g Q(d / g)  [J]       f_i = w_i A P q(d / g) n  [N]       K = -A P q'(d / g) / g n n^T  [N/m]
// The term replaces cloth_contact and is meant for comparison; pairs, weights, normals and distances are the same.
// Source: repulsion.h for q and Q; Fan, Zhou, Wang and Yuen 1998 use one law between panels and against bodies.
#pragma once
#include "../repulsion.h"
#include "cloth_contact.h"

#define cloth_repulsion_PARAMS(STRENGTH, PARAM)                                \
    STRENGTH(stiffness, 0.0, "Pa", "pressure scale of the exponential law, P") \
    PARAM(gap, 0.002, "m", "distance at which contact of cloth with cloth sets in")
#define cloth_repulsion_FIELDS(READ, ADD) cloth_contact_FIELDS(READ, ADD)
TERM_ARGS(cloth_repulsion)

// The stage that runs before each function of the term: finds the closest points, the normal and the distance.
KERNEL_FN void repulsion_frame(int pair, const cloth_repulsion_args* a)
{
    cloth_contact_args places;
    places.size = a->size;
    places.pos = a->pos;
    places.body_point = a->body_point;
    places.pair_vertex = a->pair_vertex;
    places.pair_edges = a->pair_edges;
    places.pair_weight = a->pair_weight;
    places.pair_normal = a->pair_normal;
    places.pair_distance = a->pair_distance;
    pair_frame(pair, &places);
}

KERNEL_FN barrier_jet cloth_repulsion_at(int pair, const cloth_repulsion_args* a)
{
    return repulsion_at(a->pair_distance[pair] / a->pair_gap[pair]);
}

KERNEL_FN real cloth_repulsion_energy(int pair, const cloth_repulsion_args* a)
{
    return a->pair_area[pair] * a->stiffness * a->pair_gap[pair] * cloth_repulsion_at(pair, a).value;
}

// Normal force, positive when the sides push each other apart [N].
KERNEL_FN real cloth_repulsion_push(int pair, const cloth_repulsion_args* a)
{
    return -a->pair_area[pair] * a->stiffness * cloth_repulsion_at(pair, a).slope;
}

KERNEL_FN void cloth_repulsion_force(int pair, const cloth_repulsion_args* a)
{
    int ps = a->size.pair_stride;
    vec3 push = cloth_repulsion_push(pair, a) * load3(a->pair_normal, ps, pair);
    for (int i = 0; i < 4; ++i) add3(a->pair_force + 3 * i * ps, ps, pair, a->pair_weight[i * ps + pair] * push);
}

KERNEL_FN void cloth_repulsion_stiffness(int pair, const cloth_repulsion_args* a)
{
    vec3 n = load3(a->pair_normal, a->size.pair_stride, pair);
    real k = a->pair_area[pair] * a->stiffness / a->pair_gap[pair] * cloth_repulsion_at(pair, a).curvature;
    add_block(a->pair_stiffness, a->size.pair_stride, pair, 0, outer3(k, n, n));
}
