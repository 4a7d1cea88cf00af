// Updates the friction state of a pair in contact at the end of a step: the limit L = mu N, the weights and normal that
// the next step holds, and the bristle.
//     bristle = (I - n n^T) w min(1, r / |w|),   n the new normal,   r the stick distance
// The bristle of a pair that has just come into contact is zero, so the pair starts to stick where it is.
// Source: see terms/cloth_friction.h.
#pragma once
#include "../terms/cloth_contact.h"
#include "../terms/cloth_friction.h"
#include "../terms/cloth_repulsion.h"

#define settle_pairs_FIELDS(READ, ADD) ADD(pair_held_weight) ADD(pair_held_normal) ADD(pair_bristle) ADD(pair_limit)

typedef struct {
    cloth_contact_args contact;      // weights, normals and distances are those of the present positions
    cloth_repulsion_args repulsion;  // where contact has no stiffness
    cloth_friction_args friction;
    settle_pairs_FIELDS(ARG_READ, ARG_ADD)
} settle_pairs_args;

KERNEL_FN void settle_pair(int pair, const settle_pairs_args* a)
{
    int ps = a->contact.size.pair_stride;
    vec3 n = load3(a->contact.pair_normal, ps, pair), w = pair_slip(pair, &a->friction);
    real push = a->contact.stiffness > REAL(0) ? cloth_contact_push(pair, &a->contact)
                                               : cloth_repulsion_push(pair, &a->repulsion);
    real limit = a->friction.pair_friction[pair] * push;
    real part = smaller(REAL(1), a->friction.stick_distance / larger(length(w), REAL(1e-30)));
    if (a->pair_limit[pair] <= REAL(0) || limit <= REAL(0)) part = REAL(0);
    store3(a->pair_bristle, ps, pair, part * (w - dot(n, w) * n));
    store3(a->pair_held_normal, ps, pair, n);
    for (int i = 0; i < 4; ++i) a->pair_held_weight[i * ps + pair] = a->contact.pair_weight[i * ps + pair];
    a->pair_limit[pair] = limit;
}
