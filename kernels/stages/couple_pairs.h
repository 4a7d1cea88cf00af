// The stiffness of pairs in contact:
//     K_vw = sum over pairs with corners a at v, b at w of weight_a weight_b K
// It is not assembled into the matrix, because its sparsity pattern changes with every contact. Its diagonal blocks are
// added to those of the vertices, so that the preconditioner sees them. The matrix-vector product adds the rest:
//     r_p = sum_i weight_i x_i,      y_v += sum over pairs at v of weight_a K (r_p - weight_a x_v)
// Both are done for the block of contact and for that of friction, each with its own weights.
#pragma once
#include "../linear_scalar.h"
#include "../term_args.h"

typedef struct {
    mesh_sizes size;
    GLOBAL const int* RESTRICT pair_vertex;
    GLOBAL const real* RESTRICT weight;       // of contact
    GLOBAL const real* RESTRICT held_weight;  // of friction; null: no friction
    GLOBAL const block_real* RESTRICT stiffness;
    GLOBAL const int* RESTRICT pair_slots;  // pairs around a vertex
    GLOBAL const int* RESTRICT pair_slot;
} pair_list;

typedef struct {
    pair_list list;
    GLOBAL block_real* RESTRICT vertex_stiffness;
} pair_diagonal_args;

typedef struct {
    pair_list list;
    GLOBAL const linear* RESTRICT x;   // x, y and z of a vertex are contiguous; 0 for pinned vertices
    GLOBAL linear* RESTRICT relative;  // r of contact, then of friction: six per pair
    GLOBAL linear* RESTRICT y;
    GLOBAL const real* RESTRICT inv_mass;
} couple_pairs_args;

KERNEL_FN void pair_diagonal(int vertex, const pair_diagonal_args* a)
{
    int ps = a->list.size.pair_stride, end = a->list.pair_slots[a->list.size.vertex_stride + vertex];
    for (int s = a->list.pair_slots[vertex]; s < end; ++s) {
        int pair = a->list.pair_slot[s] >> 2, corner = a->list.pair_slot[s] & 3;
        for (int kind = 0; kind < (a->list.held_weight ? 2 : 1); ++kind) {
            block_real w = (block_real)(kind ? a->list.held_weight : a->list.weight)[corner * ps + pair];
            GLOBAL const block_real* k = a->list.stiffness + 9 * (kind * ps + pair);
            for (int c = 0; c < 9; ++c) a->vertex_stiffness[9 * vertex + c] += w * w * k[c];
        }
    }
}

KERNEL_FN void couple_pairs_relative(int pair, const couple_pairs_args* a)
{
    int ps = a->list.size.pair_stride;
    for (int kind = 0; kind < (a->list.held_weight ? 2 : 1); ++kind) {
        GLOBAL const real* weight = kind ? a->list.held_weight : a->list.weight;
        linear r[3] = {0, 0, 0};
        for (int i = 0; i < 4; ++i) {
            int v = a->list.pair_vertex[i * ps + pair];
            if (v < 0) continue;
            linear w = (linear)weight[i * ps + pair];
            for (int c = 0; c < 3; ++c) r[c] += w * a->x[3 * v + c];
        }
        for (int c = 0; c < 3; ++c) a->relative[6 * pair + 3 * kind + c] = r[c];
    }
}

KERNEL_FN void couple_pairs_gather(int vertex, const couple_pairs_args* a)
{
    int ps = a->list.size.pair_stride, end = a->list.pair_slots[a->list.size.vertex_stride + vertex];
    linear sum[3] = {0, 0, 0};
    if (a->inv_mass[vertex] == REAL(0)) return;  // the row of a pinned vertex is a row of the identity
    for (int s = a->list.pair_slots[vertex]; s < end; ++s) {
        int pair = a->list.pair_slot[s] >> 2, corner = a->list.pair_slot[s] & 3;
        for (int kind = 0; kind < (a->list.held_weight ? 2 : 1); ++kind) {
            linear w = (linear)(kind ? a->list.held_weight : a->list.weight)[corner * ps + pair];
            GLOBAL const block_real* k = a->list.stiffness + 9 * (kind * ps + pair);
            linear d[3];
            for (int c = 0; c < 3; ++c) d[c] = w * (a->relative[6 * pair + 3 * kind + c] - w * a->x[3 * vertex + c]);
            for (int c = 0; c < 3; ++c) sum[c] += k[3 * c] * d[0] + k[3 * c + 1] * d[1] + k[3 * c + 2] * d[2];
        }
    }
    for (int c = 0; c < 3; ++c) a->y[3 * vertex + c] += sum[c];
}
