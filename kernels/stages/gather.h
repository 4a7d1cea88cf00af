// Sums the forces of the elements around a vertex in the fixed order of its slot list, so that the sum needs no atomics
// and is reproducible.
//     f_v += sum over (element, corner) of element_force[corner]  [N]
#pragma once
#include "../term_args.h"

typedef struct {
    GLOBAL const int* RESTRICT slots;           // first and past-last entry of each vertex
    GLOBAL const int* RESTRICT slot;            // 4 * element + corner
    GLOBAL const real* RESTRICT element_force;  // three planes per corner
    GLOBAL real* RESTRICT force;
    int vertex_stride, element_stride;
} gather_args;

KERNEL_FN void gather_force(int vertex, const gather_args* a)
{
    vec3 sum = load3(a->force, a->vertex_stride, vertex);
    int end = a->slots[a->vertex_stride + vertex];
    for (int k = a->slots[vertex]; k < end; ++k) {
        int element = a->slot[k] >> 2, corner = a->slot[k] & 3;
        sum = sum + load3(a->element_force + 3 * corner * a->element_stride, a->element_stride, element);
    }
    store3(a->force, a->vertex_stride, vertex, sum);
}
