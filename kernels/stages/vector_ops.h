// Operations on fields of real numbers. The operands of one operation may be the same field, but may not overlap
// otherwise. There are two kinds of items:
//     vector_...  an entry of a field; the entries between two planes count as well and hold 0
//     vertex_...  a vertex with its three planes, where a mask or a weight per vertex decides
// Whoever launches them takes sums over the items in a fixed order.
#pragma once
#include "../term_args.h"

typedef struct {
    GLOBAL real* y;
    real factor;
} vector_scale_args;

// y = 0. There is no value to choose, so that compilers fill memory in their fastest way.
KERNEL_FN void vector_clear(int i, const vector_scale_args* a) { a->y[i] = 0; }

// y = factor y
KERNEL_FN void vector_scale(int i, const vector_scale_args* a) { a->y[i] *= a->factor; }

typedef struct {
    GLOBAL real* y;
    real divisor;
} vector_divide_args;

// y = y / divisor
KERNEL_FN void vector_divide(int i, const vector_divide_args* a) { a->y[i] /= a->divisor; }

typedef struct {
    GLOBAL real* y;
    GLOBAL const real* x;
    GLOBAL const real* p;
    real factor;
} vector_add_args;

// y = x + factor p
KERNEL_FN void vector_add(int i, const vector_add_args* a) { a->y[i] = a->x[i] + a->factor * a->p[i]; }

// y = factor (x - p)
KERNEL_FN void vector_scale_difference(int i, const vector_add_args* a) { a->y[i] = a->factor * (a->x[i] - a->p[i]); }

typedef struct {
    GLOBAL real* y;
    GLOBAL const real* x;
} vector_root_args;

// y = sqrt(x)
KERNEL_FN void vector_root(int i, const vector_root_args* a) { a->y[i] = sqrt(a->x[i]); }

typedef struct {
    GLOBAL const real* x;
    GLOBAL const real* y;
} vector_pair_args;

// What an entry adds to x . y.
KERNEL_FN real vector_dot(int i, const vector_pair_args* a) { return a->x[i] * a->y[i]; }

// Finite in the sum over all entries only if each of them is.
KERNEL_FN real vector_magnitudes(int i, const vector_pair_args* a) { return fabs(a->x[i]) + fabs(a->y[i]); }

typedef struct {
    GLOBAL const real* x;
    GLOBAL const real* y;
    int stride;
} vertex_pair_args;

// What a vertex adds to x . y.
KERNEL_FN real vertex_dot(int vertex, const vertex_pair_args* a)
{
    return dot(load3(a->x, a->stride, vertex), load3(a->y, a->stride, vertex));
}

// |x - y|^2
KERNEL_FN real vertex_square_distance(int vertex, const vertex_pair_args* a)
{
    vec3 d = load3(a->x, a->stride, vertex) - load3(a->y, a->stride, vertex);
    return dot(d, d);
}

typedef struct {
    GLOBAL real* y;
    GLOBAL const real* weight;
    GLOBAL const real* x;
    int stride;
} vertex_weigh_args;

// y = weight x, with the weight of the vertex
KERNEL_FN void vertex_weigh(int vertex, const vertex_weigh_args* a)
{
    store3(a->y, a->stride, vertex, a->weight[vertex] * load3(a->x, a->stride, vertex));
}

typedef struct {
    GLOBAL const real* x;
    GLOBAL const real* mass;
    GLOBAL const real* inv_mass;
    int stride;
} vertex_mass_args;

// m |x|^2, and 0 at pinned vertices
KERNEL_FN real vertex_mass_square(int vertex, const vertex_mass_args* a)
{
    real square = 0;
    for (int i = vertex; i < 3 * a->stride; i += a->stride) square += a->x[i] * a->x[i];
    return a->inv_mass[vertex] == REAL(0) ? REAL(0) : a->mass[vertex] * square;
}

// Mass of a vertex, and 0 of a pinned one.
KERNEL_FN real vertex_free_mass(int vertex, const vertex_mass_args* a)
{
    return a->inv_mass[vertex] == REAL(0) ? REAL(0) : a->mass[vertex];
}

typedef struct {
    GLOBAL real* y;
    GLOBAL const real* x;
    GLOBAL const real* p;  // not read where there is only one vector
    GLOBAL const real* inv_mass;
    int stride;
} vertex_free_args;

// y = x - p, and 0 at pinned vertices
KERNEL_FN void vertex_free_difference(int vertex, const vertex_free_args* a)
{
    for (int i = vertex; i < 3 * a->stride; i += a->stride)
        a->y[i] = a->inv_mass[vertex] == REAL(0) ? REAL(0) : a->x[i] - a->p[i];
}

// y = -x, and 0 at pinned vertices
KERNEL_FN void vertex_free_negative(int vertex, const vertex_free_args* a)
{
    for (int i = vertex; i < 3 * a->stride; i += a->stride)
        a->y[i] = a->inv_mass[vertex] == REAL(0) ? REAL(0) : -a->x[i];
}

// y = x where the vertex is not pinned
KERNEL_FN void vertex_free_copy(int vertex, const vertex_free_args* a)
{
    if (a->inv_mass[vertex] == REAL(0)) return;
    for (int i = vertex; i < 3 * a->stride; i += a->stride) a->y[i] = a->x[i];
}

typedef struct {
    GLOBAL real* y;
    GLOBAL const real* inv_mass;  // null: pinned vertices are not looked for
    GLOBAL const char* is_awake;  // null: no vertex is asleep
    int stride;
} vertex_rest_args;

// y = 0 at vertices that are pinned or asleep
KERNEL_FN void vertex_clear_resting(int vertex, const vertex_rest_args* a)
{
    int is_free = !a->inv_mass || a->inv_mass[vertex] != REAL(0);
    if (is_free && (!a->is_awake || a->is_awake[vertex])) return;
    for (int i = vertex; i < 3 * a->stride; i += a->stride) a->y[i] = 0;
}

typedef struct {
    GLOBAL const real* x;
    GLOBAL const char* is_awake;
    int stride;
} vertex_mask_args;

// |x|^2 at vertices that are asleep, 0 at others
KERNEL_FN real vertex_square_asleep(int vertex, const vertex_mask_args* a)
{
    vec3 x = load3(a->x, a->stride, vertex);
    return a->is_awake[vertex] ? REAL(0) : dot(x, x);
}

typedef struct {
    GLOBAL real* field;
    int planes, stride;
} clear_planes_args;

// Sets all planes of an item to 0.
KERNEL_FN void clear_planes(int item, const clear_planes_args* a)
{
    for (int p = 0; p < a->planes; ++p) a->field[p * a->stride + item] = 0;
}

typedef struct {
    GLOBAL block_real* field;
    int blocks, stride;
} clear_blocks_args;

// Sets all stiffness blocks of an item to 0.
KERNEL_FN void clear_blocks(int item, const clear_blocks_args* a)
{
    for (int b = 0; b < a->blocks; ++b)
        for (int c = 0; c < 9; ++c) a->field[9 * (b * a->stride + item) + c] = 0;
}

typedef struct {
    GLOBAL block_real* field;
    block_real factor;
} block_scale_args;

// Sets one number of a field of blocks to 0.
KERNEL_FN void block_clear(int i, const block_scale_args* a) { a->field[i] = 0; }

// Scales the block of a vertex.
KERNEL_FN void block_scale(int vertex, const block_scale_args* a)
{
    for (int i = 9 * vertex; i < 9 * vertex + 9; ++i) a->field[i] *= a->factor;
}
