// Operations on rows of 3x3 blocks and on vectors with three entries per vertex, xyz together.
#pragma once
#include "../linear_scalar.h"

typedef struct {
    GLOBAL const int* RESTRICT row_begin;
    GLOBAL const int* RESTRICT column;
    GLOBAL const linear* RESTRICT block;   // nine entries per block, by rows
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
    GLOBAL const linear* RESTRICT block;   // one block per vertex
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
