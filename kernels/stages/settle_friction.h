// Updates the friction anchor and the limit L = mu N of a vertex at the end of a step.
//     L = 0:   anchor = x                (out of contact the anchor moves with the vertex)
//     q > r:   anchor = x - w r / q      (a sliding vertex drags its anchor at the stick distance r)
// with w = (I - n n^T)(x - anchor) and q = |w|. Source: see terms/friction.h.
#pragma once
#include "../terms/body_contact.h"
#include "../terms/body_repulsion.h"

#define settle_friction_FIELDS(READ, ADD) READ(contact_friction) ADD(friction_anchor) ADD(friction_limit)

typedef struct {
    body_contact_args contact;
    body_repulsion_args repulsion;  // where contact has no stiffness
    settle_friction_FIELDS(ARG_READ, ARG_ADD) real stick_distance;
} settle_friction_args;

KERNEL_FN void settle_friction_vertex(int vertex, const settle_friction_args* a)
{
    int vs = a->contact.size.vertex_stride;
    vec3 n = load3(a->contact.contact_normal, vs, vertex), x = load3(a->contact.pos, vs, vertex);
    real push = a->contact.stiffness > REAL(0) ? body_contact_pressure_force(vertex, &a->contact)
                                               : body_repulsion_push(vertex, &a->repulsion);
    real limit = a->contact_friction[vertex] * push;
    vec3 d = x - load3(a->friction_anchor, vs, vertex);
    vec3 w = d - dot(n, d) * n;
    real q = length(w);
    // A vertex that has just come into contact starts to stick at its present position.
    vec3 anchor = a->friction_limit[vertex] > REAL(0)
                      ? x - (smaller(REAL(1), a->stick_distance / larger(q, REAL(1e-30)))) * w
                      : x;
    a->friction_limit[vertex] = limit;
    store3(a->friction_anchor, vs, vertex, limit > REAL(0) ? anchor : x);
}
