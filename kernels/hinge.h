// The dihedral angle theta of a hinge and its derivatives. A hinge is the edge x0 x1 with the faces (0, 1, 2) and
// (1, 0, 3); theta is 0 when it is flat.
//     dtheta/dx2 = -|e| n1 / |n1|^2,   n1 = e x (x2 - x0);   likewise for x3 with n2 = (x3 - x0) x e
// Only sin(theta/2) and cos(theta/2) are computed. This avoids inverse trigonometric functions and the jump of theta
// where a fold passes 180 degrees.
// Source: Bridson, Marino and Fedkiw 2003, section 4; second derivatives of theta by differentiating its mode vectors.
#pragma once
#include "term_args.h"

typedef struct {
    vec3 e, p, q;         // x1 - x0, x2 - x0, x3 - x0
    vec3 n1, n2;          // face normals, twice the area long
    real inv_n1, inv_n2;  // 1/|n1|^2, 1/|n2|^2
    real length;          // |e|
    real b2, b3;          // projections of x2 and x3 on the edge, 0 at x0, 1 at x1
    real sine, cosine;    // of theta/2
    vec3 g[4];            // dtheta/dx_i
} hinge_state;

KERNEL_FN hinge_state hinge_at(int hinge, mesh_sizes size, GLOBAL const real* pos, GLOBAL const int* hinge_vertex)
{
    int hs = size.hinge_stride, vs = size.vertex_stride;
    hinge_state h;
    vec3 x0 = load3(pos, vs, hinge_vertex[hinge]);
    h.e = load3(pos, vs, hinge_vertex[hs + hinge]) - x0;
    h.p = load3(pos, vs, hinge_vertex[2 * hs + hinge]) - x0;
    h.q = load3(pos, vs, hinge_vertex[3 * hs + hinge]) - x0;
    h.n1 = cross(h.e, h.p);
    h.n2 = cross(h.q, h.e);
    // A face of zero area has no normal. The floors keep its forces finite until the face has area again: |e| counts as
    // at least 1 nm, and the height over the edge as at least |e|/1000. Both were chosen by hand; not measured.
    real e2 = larger(dot(h.e, h.e), REAL(1e-18));
    h.length = sqrt(e2);
    h.inv_n1 = REAL(1) / larger(dot(h.n1, h.n1), REAL(1e-6) * e2 * e2);
    h.inv_n2 = REAL(1) / larger(dot(h.n2, h.n2), REAL(1e-6) * e2 * e2);
    h.b2 = dot(h.p, h.e) / e2;
    h.b3 = dot(h.q, h.e) / e2;
    vec3 u1 = sqrt(h.inv_n1) * h.n1, u2 = sqrt(h.inv_n2) * h.n2;
    real sine = REAL(0.5) * length(u1 - u2);
    h.sine = dot(cross(u1, u2), h.e) < REAL(0) ? -sine : sine;
    h.cosine = REAL(0.5) * length(u1 + u2);
    h.g[2] = (-h.length * h.inv_n1) * h.n1;
    h.g[3] = (-h.length * h.inv_n2) * h.n2;
    h.g[0] = (h.b2 - REAL(1)) * h.g[2] + (h.b3 - REAL(1)) * h.g[3];
    h.g[1] = (-h.b2) * h.g[2] + (-h.b3) * h.g[3];
    return h;
}

KERNEL_FN mat3 hinge_cross_matrix(vec3 v)
{
    mat3 m;
    m.row0 = make_vec3(0, -v.z, v.y);
    m.row1 = make_vec3(v.z, 0, -v.x);
    m.row2 = make_vec3(-v.y, v.x, 0);
    return m;
}

// s (I - 2 n n^T / |n|^2) [v]x / |n|^2: s times the derivative of n/|n|^2 with respect to x when dn = v x dx.
KERNEL_FN mat3 hinge_normal_derivative(real s, vec3 n, real inv_n, vec3 v)
{
    return mat3_add(mat3_scale(s * inv_n, hinge_cross_matrix(v)), outer3(REAL(-2) * s * inv_n * inv_n, n, cross(n, v)));
}

// Second derivatives of theta: blocks t[i][j] = d2theta/dx_i dx_j for i < j. Translation invariance gives the blocks of
// x0: each row of blocks sums to zero.
KERNEL_FN void hinge_angle_hessian(const hinge_state* h, mat3 t[4][4])
{
    vec3 unit = (REAL(1) / h->length) * h->e;
    real inv_e2 = REAL(1) / (h->length * h->length);
    mat3 t21 = mat3_add(outer3(-h->inv_n1, h->n1, unit), hinge_normal_derivative(h->length, h->n1, h->inv_n1, h->p));
    mat3 t31 = mat3_add(outer3(-h->inv_n2, h->n2, unit), hinge_normal_derivative(-h->length, h->n2, h->inv_n2, h->q));
    vec3 db2 = inv_e2 * (h->p - (REAL(2) * h->b2) * h->e), db3 = inv_e2 * (h->q - (REAL(2) * h->b3) * h->e);
    mat3 t11 = mat3_add(mat3_add(outer3(REAL(-1), h->g[2], db2), mat3_scale(-h->b2, t21)),
                        mat3_add(outer3(REAL(-1), h->g[3], db3), mat3_scale(-h->b3, t31)));
    mat3 t22 = hinge_normal_derivative(-h->length, h->n1, h->inv_n1, h->e);
    mat3 t33 = hinge_normal_derivative(h->length, h->n2, h->inv_n2, h->e);
    t[1][2] = mat3_transpose(t21);
    t[1][3] = mat3_transpose(t31);
    t[2][3] = outer3(REAL(0), unit, unit);
    t[0][1] = mat3_scale(REAL(-1), mat3_transpose(mat3_add(t11, mat3_add(t[1][2], t[1][3]))));
    t[0][2] = mat3_scale(REAL(-1), mat3_add(t[1][2], t22));
    t[0][3] = mat3_scale(REAL(-1), mat3_add(t[1][3], t33));
}
