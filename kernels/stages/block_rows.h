// Operations on rows of 3x3 blocks and on vectors that store x, y and z of a vertex contiguously.
#pragma once
#include "../linear_scalar.h"

typedef struct {
    GLOBAL const int* RESTRICT row_begin;
    GLOBAL const int* RESTRICT column;
    GLOBAL const linear* RESTRICT block;  // nine entries per block, by rows
    GLOBAL const linear* RESTRICT x;
    GLOBAL linear* RESTRICT y;
} block_rows_args;

// y = A x for one row.
KERNEL_FN void block_row_product(int row, const block_rows_args* a)
{
    linear s0 = 0, s1 = 0, s2 = 0;
    int end = a->row_begin[row + 1];
    for (int k = a->row_begin[row]; k < end; ++k) {
        GLOBAL const linear* m = a->block + 9 * k;
        GLOBAL const linear* x = a->x + 3 * a->column[k];
        s0 += m[0] * x[0] + m[1] * x[1] + m[2] * x[2];
        s1 += m[3] * x[0] + m[4] * x[1] + m[5] * x[2];
        s2 += m[6] * x[0] + m[7] * x[1] + m[8] * x[2];
    }
    a->y[3 * row] = s0;
    a->y[3 * row + 1] = s1;
    a->y[3 * row + 2] = s2;
}

typedef struct {
    GLOBAL const linear* RESTRICT block;  // one block per vertex
    GLOBAL const linear* RESTRICT x;
    GLOBAL linear* RESTRICT y;
} block_diagonal_args;

// y = D x for one vertex, D block diagonal.
KERNEL_FN void block_diagonal_product(int row, const block_diagonal_args* a)
{
    GLOBAL const linear* m = a->block + 9 * row;
    GLOBAL const linear* x = a->x + 3 * row;
    GLOBAL linear* y = a->y + 3 * row;
    linear y0 = m[0] * x[0] + m[1] * x[1] + m[2] * x[2];
    linear y1 = m[3] * x[0] + m[4] * x[1] + m[5] * x[2];
    linear y2 = m[6] * x[0] + m[7] * x[1] + m[8] * x[2];
    y[0] = y0;
    y[1] = y1;
    y[2] = y2;
}

// One step of a multigrid smoother with a block Jacobi preconditioner D, for one row:
//     d' = keep d + gain D^-1 (b - A x),   x' = x + d'
// All of it is one pass over the matrix, with x' in an array of its own. A separate pass for each operation would move
// four more vectors through memory.
typedef struct {
    GLOBAL const int* RESTRICT row_begin;
    GLOBAL const int* RESTRICT column;
    GLOBAL const linear* RESTRICT block;
    GLOBAL const linear* RESTRICT inverse;  // one block per vertex
    GLOBAL const linear* RESTRICT b;
    GLOBAL const linear* RESTRICT x;
    GLOBAL linear* RESTRICT d;
    GLOBAL linear* RESTRICT next;
    linear keep, gain;
} block_smooth_args;

KERNEL_FN void block_row_smooth(int row, const block_smooth_args* a)
{
    linear r0 = a->b[3 * row], r1 = a->b[3 * row + 1], r2 = a->b[3 * row + 2];
    int end = a->row_begin[row + 1];
    for (int k = a->row_begin[row]; k < end; ++k) {
        GLOBAL const linear* m = a->block + 9 * k;
        GLOBAL const linear* x = a->x + 3 * a->column[k];
        r0 -= m[0] * x[0] + m[1] * x[1] + m[2] * x[2];
        r1 -= m[3] * x[0] + m[4] * x[1] + m[5] * x[2];
        r2 -= m[6] * x[0] + m[7] * x[1] + m[8] * x[2];
    }
    GLOBAL const linear* m = a->inverse + 9 * row;
    linear z[3];
    z[0] = m[0] * r0 + m[1] * r1 + m[2] * r2;
    z[1] = m[3] * r0 + m[4] * r1 + m[5] * r2;
    z[2] = m[6] * r0 + m[7] * r1 + m[8] * r2;
    for (int c = 0; c < 3; ++c) {
        int i = 3 * row + c;
        linear d = a->keep * a->d[i] + a->gain * z[c];
        a->d[i] = d;
        a->next[i] = a->x[i] + d;
    }
}

// The same step from x = 0 and d = 0, which needs no matrix product.
KERNEL_FN void block_row_smooth_zero(int row, const block_smooth_args* a)
{
    GLOBAL const linear* m = a->inverse + 9 * row;
    GLOBAL const linear* b = a->b + 3 * row;
    for (int c = 0; c < 3; ++c) {
        linear d = a->gain * (m[3 * c] * b[0] + m[3 * c + 1] * b[1] + m[3 * c + 2] * b[2]);
        a->d[3 * row + c] = d;
        a->next[3 * row + c] = d;
    }
}

// next = b - A x for one row.
KERNEL_FN void block_row_residual(int row, const block_smooth_args* a)
{
    linear r0 = a->b[3 * row], r1 = a->b[3 * row + 1], r2 = a->b[3 * row + 2];
    int end = a->row_begin[row + 1];
    for (int k = a->row_begin[row]; k < end; ++k) {
        GLOBAL const linear* m = a->block + 9 * k;
        GLOBAL const linear* x = a->x + 3 * a->column[k];
        r0 -= m[0] * x[0] + m[1] * x[1] + m[2] * x[2];
        r1 -= m[3] * x[0] + m[4] * x[1] + m[5] * x[2];
        r2 -= m[6] * x[0] + m[7] * x[1] + m[8] * x[2];
    }
    a->next[3 * row] = r0;
    a->next[3 * row + 1] = r1;
    a->next[3 * row + 2] = r2;
}
