// Lets friction take up at once, as far as it can, what would set a resting vertex in motion.
//     t = (I - n n^T) f,   anchor = x - r t / max(L, |t|)   where v = 0 and L > 0, f the force of all else on the
//     vertex
// Source: Coulomb's law at rest; see terms/friction.h. Without it cloth that starts at rest would fall into its
// anchors' elastic way, and slide off where friction only just holds it.
#pragma once
#include "../portable.h"

typedef struct {
    GLOBAL const real* RESTRICT pos;
    GLOBAL const real* RESTRICT vel;
    GLOBAL const real* RESTRICT force;
    GLOBAL const real* RESTRICT normal;
    GLOBAL const real* RESTRICT limit;
    GLOBAL real* RESTRICT anchor;
    real stick_distance;
    int stride;
} hold_friction_args;

KERNEL_FN void hold_friction_vertex(int vertex, const hold_friction_args* a)
{
    vec3 v = load3(a->vel, a->stride, vertex), n = load3(a->normal, a->stride, vertex);
    real limit = a->limit[vertex];
    if (limit <= REAL(0) || dot(v, v) > REAL(0)) return;
    vec3 f = load3(a->force, a->stride, vertex), t = f - dot(n, f) * n;
    real way = a->stick_distance / larger(limit, length(t));
    store3(a->anchor, a->stride, vertex, load3(a->pos, a->stride, vertex) - way * t);
}
