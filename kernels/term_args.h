// Turns a term's two lists, <term>_PARAMS and <term>_FIELDS, into the argument struct of its functions.
#pragma once
#include "portable.h"

// Kinds of items. Each has a count and a stride, the count rounded up for alignment.
// clang-format off
#define ITEM_KINDS(KIND)                                                                      \
    KIND(vertex) KIND(face) KIND(hinge) KIND(stitch) KIND(spring) KIND(pair) KIND(body_point) \
    KIND(material) KIND(coupling)                                                             \
    KIND(face_slot) KIND(hinge_slot) KIND(stitch_slot) KIND(spring_slot) KIND(pair_slot)
// clang-format on

// Kinds whose items join several vertices, with the number of corners. Their forces are gathered at the vertices.
// Elements belong to the cloth, so their stiffness has a fixed place in the matrix. Pairs appear and disappear with
// contact, so theirs has none.
#define ELEMENT_KINDS(KIND) \
    KIND(face, 3)           \
    KIND(hinge, 4)          \
    KIND(stitch, 2)         \
    KIND(spring, 2)
#define GATHERED_KINDS(KIND) ELEMENT_KINDS(KIND) KIND(pair, 4)

#define SIZE_MEMBERS(kind) int kind##_count, kind##_stride;
typedef struct {
    ITEM_KINDS(SIZE_MEMBERS)
} mesh_sizes;
#undef SIZE_MEMBERS

// Which stiffness a term computes.
typedef struct {
    int projected;  // 1: drop the parts that could make the element matrix indefinite; 0: exact second derivatives
} stiffness_mode;

#define FIELD(type, name, per, components, unit, meaning) typedef type name##_type;
#include "fields.def"

#define ARG_READ(name) GLOBAL const name##_type* RESTRICT name;
#define ARG_ADD(name) GLOBAL name##_type* RESTRICT name;
#define ARG_PARAM(name, initial, unit, meaning) real name;
#define TERM_ARGS(term)                                                      \
    typedef struct {                                                         \
        mesh_sizes size;                                                     \
        stiffness_mode mode;                                                 \
        term##_FIELDS(ARG_READ, ARG_ADD) term##_PARAMS(ARG_PARAM, ARG_PARAM) \
    } term##_args;

// Position of block (a, b), a < b, in the stiffness slot of an element with `corners` vertices.
KERNEL_FN int block_index(int corners, int a, int b) { return a * (2 * corners - a - 1) / 2 + b - a - 1; }

// Adds a block to a stiffness slot. The nine entries of a block are contiguous because the assembly of a matrix row
// reads whole blocks of scattered items, and one cache line then serves a whole block.
KERNEL_FN void add_block(GLOBAL block_real* slots, int stride, int item, int block, mat3 m)
{
    GLOBAL block_real* to = slots + 9 * (block * stride + item);
    to[0] += (block_real)m.row0.x;
    to[1] += (block_real)m.row0.y;
    to[2] += (block_real)m.row0.z;
    to[3] += (block_real)m.row1.x;
    to[4] += (block_real)m.row1.y;
    to[5] += (block_real)m.row1.z;
    to[6] += (block_real)m.row2.x;
    to[7] += (block_real)m.row2.y;
    to[8] += (block_real)m.row2.z;
}
