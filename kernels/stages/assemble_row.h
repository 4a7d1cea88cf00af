// Assembles one row of 3x3 blocks of the system matrix from the element stiffness slots around a vertex.
//     A_ij = sum over elements with corners (a at i, b at j) of K_ab,   i != j
//     A_ii = -sum over elements with corner a at i of sum_b K_ab  +  vertex stiffness + inertia m_i I
// The rows of pinned vertices become rows of the identity. Their columns are kept: a prescribed displacement of a
// pinned vertex acts on its neighbours through them.
#pragma once
#include "../linear_scalar.h"
#include "../term_args.h"

typedef struct {
    GLOBAL const int* RESTRICT row_begin;  // first block of each row; one more entry than rows
    GLOBAL const int* RESTRICT column;
    GLOBAL linear* RESTRICT block;  // nine entries per block, by rows
    GLOBAL const real* RESTRICT mass;
    GLOBAL const real* RESTRICT inv_mass;
    GLOBAL const block_real* RESTRICT vertex_stiffness;  // may be null
    int vertex_stride;
    real inertia;  // 1/dt^2 [1/s^2]
} assemble_args;

// The elements of one kind around each vertex.
typedef struct {
    GLOBAL const int* RESTRICT slots;             // first and past-last entry of each vertex
    GLOBAL const int* RESTRICT slot;              // 4 * element + corner
    GLOBAL const unsigned short* RESTRICT place;  // per slot entry and corner: index within the row of the block
    GLOBAL const block_real* RESTRICT stiffness;  // null: the kind is not in use
    int corners, stride;
} assemble_kind;

KERNEL_FN void assemble_clear(int row, const assemble_args* a)
{
    for (int k = 9 * a->row_begin[row]; k < 9 * a->row_begin[row + 1]; ++k) a->block[k] = 0;
}

// Adds an off-diagonal block (its transpose if not `upright`) to the row and subtracts it from the diagonal block,
// since the rows of an element matrix sum to zero.
KERNEL_FN void assemble_add(GLOBAL linear* RESTRICT to, GLOBAL linear* RESTRICT own,
                            GLOBAL const block_real* RESTRICT from, int upright)
{
    if (upright) {
        for (int c = 0; c < 9; ++c) {
            to[c] += (linear)from[c];
            own[c] -= (linear)from[c];
        }
    } else {
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) {
                to[3 * r + c] += (linear)from[3 * c + r];
                own[3 * r + c] -= (linear)from[3 * c + r];
            }
    }
}

KERNEL_FN void assemble_elements(int row, const assemble_args* a, const assemble_kind* kind)
{
    GLOBAL linear* first = a->block + 9 * a->row_begin[row];
    int end = kind->slots[a->vertex_stride + row];
    for (int s = kind->slots[row]; s < end; ++s) {
        int element = kind->slot[s] >> 2, corner = kind->slot[s] & 3;
        GLOBAL const unsigned short* place = kind->place + kind->corners * s;
        GLOBAL linear* own = first + 9 * place[corner];
        for (int other = 0; other < kind->corners; ++other) {
            if (other == corner) continue;
            int low = corner < other ? corner : other, high = corner < other ? other : corner;
            GLOBAL const block_real* from =
                kind->stiffness + 9 * (block_index(kind->corners, low, high) * kind->stride + element);
            assemble_add(first + 9 * place[other], own, from, corner < other);
        }
    }
}

KERNEL_FN void assemble_finish(int row, const assemble_args* a)
{
    int pinned = a->inv_mass[row] == REAL(0);
    for (int k = a->row_begin[row]; k < a->row_begin[row + 1]; ++k) {
        GLOBAL linear* to = a->block + 9 * k;
        int diagonal = a->column[k] == row;
        if (pinned) {
            for (int c = 0; c < 9; ++c) to[c] = diagonal && c % 4 == 0;
        } else if (diagonal) {
            for (int c = 0; c < 9 && a->vertex_stiffness; ++c) to[c] += (linear)a->vertex_stiffness[9 * row + c];
            for (int c = 0; c < 9; c += 4) to[c] += (linear)(a->inertia * a->mass[row]);
        }
    }
}
