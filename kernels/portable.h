// Makes one kernel source valid as C++20 and as OpenCL C 1.2. No other kernel file tests the language.
#pragma once
// clang-format off: it would remove the indentation of the preprocessor branches.
#ifdef __OPENCL_C_VERSION__
    #define GLOBAL __global
    #define RESTRICT restrict
    #ifdef cl_khr_fp64
typedef double real;
typedef double3 vec3;  // dot, cross and length are built in
    #else
typedef float real;
typedef float3 vec3;
    #endif
    #define make_vec3(x, y, z) ((vec3)(x, y, z))
    #define larger fmax
    #define smaller fmin
#else
    #include <cmath>
    #define GLOBAL
    #define RESTRICT __restrict__
typedef double real;  // with float positions the relative force residual stays above 5 %
struct vec3 {
    real x, y, z;
};
using std::asin;
using std::exp;
using std::fabs;
using std::log;
using std::sqrt;
// Written out because a call of the C library's fmax costs more than the kernels that use it.
static inline real larger(real a, real b) { return a > b ? a : b; }
static inline real smaller(real a, real b) { return a < b ? a : b; }
static inline vec3 make_vec3(real x, real y, real z) { return {x, y, z}; }
static inline vec3 operator+(vec3 a, vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline vec3 operator-(vec3 a, vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline vec3 operator*(real s, vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
static inline real dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vec3 cross(vec3 a, vec3 b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline real length(vec3 a) { return sqrt(dot(a, a)); }
#endif
// clang-format on
#define KERNEL_FN static inline
typedef float block_real;  // of stiffness slots: float suffices because stiffness affects only the search direction
#define REAL(constant) ((real)(constant))

// A field with several components is a structure of arrays: one plane per component, `stride` entries apart.
KERNEL_FN vec3 load3(GLOBAL const real* plane, int stride, int item)
{
    return make_vec3(plane[item], plane[stride + item], plane[2 * stride + item]);
}

KERNEL_FN void store3(GLOBAL real* plane, int stride, int item, vec3 value)
{
    plane[item] = value.x;
    plane[stride + item] = value.y;
    plane[2 * stride + item] = value.z;
}

KERNEL_FN void add3(GLOBAL real* plane, int stride, int item, vec3 value)
{
    plane[item] += value.x;
    plane[stride + item] += value.y;
    plane[2 * stride + item] += value.z;
}

// A symmetric 3x3 matrix: the rows of its upper triangle.
typedef struct {
    real xx, xy, xz, yy, yz, zz;
} sym3;
// A general 3x3 matrix, by rows.
typedef struct {
    vec3 row0, row1, row2;
} mat3;

KERNEL_FN mat3 outer3(real s, vec3 a, vec3 b)
{
    mat3 m;
    m.row0 = (s * a.x) * b;
    m.row1 = (s * a.y) * b;
    m.row2 = (s * a.z) * b;
    return m;
}

KERNEL_FN mat3 mat3_add(mat3 a, mat3 b)
{
    mat3 m;
    m.row0 = a.row0 + b.row0;
    m.row1 = a.row1 + b.row1;
    m.row2 = a.row2 + b.row2;
    return m;
}

KERNEL_FN mat3 mat3_scale(real s, mat3 a)
{
    mat3 m;
    m.row0 = s * a.row0;
    m.row1 = s * a.row1;
    m.row2 = s * a.row2;
    return m;
}

KERNEL_FN mat3 mat3_add_diagonal(mat3 a, real s)
{
    a.row0.x += s;
    a.row1.y += s;
    a.row2.z += s;
    return a;
}

KERNEL_FN mat3 mat3_transpose(mat3 a)
{
    mat3 m;
    m.row0 = make_vec3(a.row0.x, a.row1.x, a.row2.x);
    m.row1 = make_vec3(a.row0.y, a.row1.y, a.row2.y);
    m.row2 = make_vec3(a.row0.z, a.row1.z, a.row2.z);
    return m;
}
