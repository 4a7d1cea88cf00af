// Operations on the vectors of the linear solver, which hold xyz of one row together, and the way between them and the
// planes of the state.
#pragma once
#include "../linear_scalar.h"

typedef struct {
    GLOBAL linear* y;
    linear factor;
} row_scale_args;

KERNEL_FN void row_clear(int row, const row_scale_args* a)
{
    for (int i = 3 * row; i < 3 * row + 3; ++i) a->y[i] = 0;
}

// y = factor y
KERNEL_FN void row_scale(int row, const row_scale_args* a)
{
    for (int i = 3 * row; i < 3 * row + 3; ++i) a->y[i] *= a->factor;
}

typedef struct {
    GLOBAL const linear* x;
    GLOBAL const linear* y;
} row_dot_args;

// What a row adds to x . y. The products have the precision of the state's numbers, which are summed.
KERNEL_FN real row_dot(int row, const row_dot_args* a)
{
    GLOBAL const linear* x = a->x + 3 * row;
    GLOBAL const linear* y = a->y + 3 * row;
    return (real)x[0] * (real)y[0] + (real)x[1] * (real)y[1] + (real)x[2] * (real)y[2];
}

typedef struct {
    GLOBAL linear* RESTRICT x;
    GLOBAL linear* RESTRICT r;
    GLOBAL const linear* RESTRICT p;
    GLOBAL const linear* RESTRICT q;
    linear step;
} row_advance_args;

// x += step p,   r -= step q
KERNEL_FN void row_advance(int row, const row_advance_args* a)
{
    for (int i = 3 * row; i < 3 * row + 3; ++i) {
        a->x[i] += a->step * a->p[i];
        a->r[i] -= a->step * a->q[i];
    }
}

typedef struct {
    GLOBAL linear* RESTRICT p;
    GLOBAL const linear* RESTRICT z;
    linear turn;
} row_turn_args;

// p = z + turn p
KERNEL_FN void row_turn(int row, const row_turn_args* a)
{
    for (int i = 3 * row; i < 3 * row + 3; ++i) a->p[i] = a->z[i] + a->turn * a->p[i];
}

typedef struct {
    GLOBAL linear* RESTRICT row;
    GLOBAL const real* RESTRICT plane;
    int stride;
    real divisor;
} row_pack_args;

// row = planes / divisor
KERNEL_FN void row_pack(int row, const row_pack_args* a)
{
    for (int c = 0; c < 3; ++c) a->row[3 * row + c] = (linear)(a->plane[c * a->stride + row] / a->divisor);
}

typedef struct {
    GLOBAL real* RESTRICT plane;
    GLOBAL const linear* RESTRICT row;
    int stride;
    real factor;
} row_unpack_args;

// planes = factor row
KERNEL_FN void row_unpack(int row, const row_unpack_args* a)
{
    for (int c = 0; c < 3; ++c) a->plane[c * a->stride + row] = a->factor * (real)a->row[3 * row + c];
}

// A sparse matrix of weights that carries vectors between two levels of the multigrid.
typedef struct {
    GLOBAL const int* RESTRICT row_begin;
    GLOBAL const int* RESTRICT column;
    GLOBAL const linear* RESTRICT weight;
    GLOBAL const linear* RESTRICT x;
    GLOBAL linear* RESTRICT y;
} row_transfer_args;

// y = W x
KERNEL_FN void row_restrict(int row, const row_transfer_args* a)
{
    linear sum[3] = {0, 0, 0};
    for (int k = a->row_begin[row]; k < a->row_begin[row + 1]; ++k)
        for (int c = 0; c < 3; ++c) sum[c] += a->weight[k] * a->x[3 * a->column[k] + c];
    for (int c = 0; c < 3; ++c) a->y[3 * row + c] = sum[c];
}

// y += W x
KERNEL_FN void row_prolong(int row, const row_transfer_args* a)
{
    for (int k = a->row_begin[row]; k < a->row_begin[row + 1]; ++k)
        for (int c = 0; c < 3; ++c) a->y[3 * row + c] += a->weight[k] * a->x[3 * a->column[k] + c];
}
