// The part of the plate's stiffness that is not assembled into the matrix: y += J^T (G - W) J x, in three stages.
//     turn_h = J_h . x                                  for each hinge h
//     moment_h = sum_k G_hk turn_k - W_h turn_h         for each hinge h
//     y_v += sum over hinges at v of J_h^T moment_h     for each vertex v
// This moves less than half of the bytes of an assembled matrix, which would have 37 blocks a row. See terms/plate.h.
#pragma once
#include "../linear_scalar.h"
#include "../term_args.h"

typedef struct {
    GLOBAL const int* RESTRICT hinge_vertex;
    GLOBAL const block_real* RESTRICT slope;  // J: twelve entries per hinge, by corners
    GLOBAL const real* RESTRICT own;          // W [N m]
    GLOBAL const int* RESTRICT coupling_slots;
    GLOBAL const int* RESTRICT coupling_hinge;
    GLOBAL const block_real* RESTRICT coupling_rigidity;
    GLOBAL const int* RESTRICT hinge_slots;  // hinges around a vertex
    GLOBAL const int* RESTRICT hinge_slot;
    GLOBAL const linear* RESTRICT x;  // x, y and z of a vertex are contiguous
    GLOBAL linear* RESTRICT turn;
    GLOBAL linear* RESTRICT moment;
    GLOBAL linear* RESTRICT y;
    int hinge_stride, vertex_stride;
} couple_args;

KERNEL_FN void couple_turn(int hinge, const couple_args* a)
{
    linear turn = 0;
    for (int i = 0; i < 4; ++i) {
        GLOBAL const linear* x = a->x + 3 * a->hinge_vertex[i * a->hinge_stride + hinge];
        GLOBAL const block_real* slope = a->slope + 12 * hinge + 3 * i;
        turn += slope[0] * x[0] + slope[1] * x[1] + slope[2] * x[2];
    }
    a->turn[hinge] = turn;
}

KERNEL_FN void couple_moment(int hinge, const couple_args* a)
{
    linear moment = -(linear)a->own[hinge] * a->turn[hinge];
    int end = a->coupling_slots[a->hinge_stride + hinge];
    for (int k = a->coupling_slots[hinge]; k < end; ++k)
        moment += a->coupling_rigidity[k] * a->turn[a->coupling_hinge[k]];
    a->moment[hinge] = moment;
}

KERNEL_FN void couple_gather(int vertex, const couple_args* a)
{
    linear sum[3] = {0, 0, 0};
    int end = a->hinge_slots[a->vertex_stride + vertex];
    for (int s = a->hinge_slots[vertex]; s < end; ++s) {
        int hinge = a->hinge_slot[s] >> 2, corner = a->hinge_slot[s] & 3;
        GLOBAL const block_real* slope = a->slope + 12 * hinge + 3 * corner;
        for (int c = 0; c < 3; ++c) sum[c] += slope[c] * a->moment[hinge];
    }
    for (int c = 0; c < 3; ++c) a->y[3 * vertex + c] += sum[c];
}
