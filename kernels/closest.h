// Closest points of a point and a triangle, and of two segments, as weights on their four corners.
// Source: Ericson 2005, chapters 5.1.5 and 5.1.9.
#pragma once
#include "portable.h"

typedef struct {
    real w[4];
} pair_weights;

KERNEL_FN real unit_interval(real t) { return smaller(REAL(1), larger(REAL(0), t)); }

KERNEL_FN pair_weights face_weights(real b, real c)
{
    pair_weights p;
    p.w[0] = REAL(1);
    p.w[1] = b + c - REAL(1);
    p.w[2] = -b;
    p.w[3] = -c;
    return p;
}

// Weights (1, -a, -b, -c) of x and of the point a f0 + b f1 + c f2 of the face that is closest to it.
KERNEL_FN pair_weights closest_point_face(vec3 x, vec3 f0, vec3 f1, vec3 f2)
{
    vec3 e1 = f1 - f0, e2 = f2 - f0, d = x - f0;
    real d1 = dot(e1, d), d2 = dot(e2, d);
    if (d1 <= REAL(0) && d2 <= REAL(0)) return face_weights(REAL(0), REAL(0));
    d = x - f1;
    real d3 = dot(e1, d), d4 = dot(e2, d);
    if (d3 >= REAL(0) && d4 <= d3) return face_weights(REAL(1), REAL(0));
    real c = d1 * d4 - d3 * d2;
    if (c <= REAL(0) && d1 >= REAL(0) && d3 <= REAL(0)) return face_weights(d1 / (d1 - d3), REAL(0));
    d = x - f2;
    real d5 = dot(e1, d), d6 = dot(e2, d);
    if (d6 >= REAL(0) && d5 <= d6) return face_weights(REAL(0), REAL(1));
    real b = d5 * d2 - d1 * d6;
    if (b <= REAL(0) && d2 >= REAL(0) && d6 <= REAL(0)) return face_weights(REAL(0), d2 / (d2 - d6));
    real a = d3 * d6 - d5 * d4;
    if (a <= REAL(0) && d4 >= d3 && d5 >= d6) {
        real t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return face_weights(REAL(1) - t, t);
    }
    real sum = a + b + c;
    return face_weights(b / sum, c / sum);
}

// Weights (1, -a, -b, -c) of x and of the point of the face's plane that is closest to it, also beyond the face.
KERNEL_FN pair_weights closest_point_plane(vec3 x, vec3 f0, vec3 f1, vec3 f2)
{
    vec3 e1 = f1 - f0, e2 = f2 - f0, d = x - f0;
    real a = dot(e1, e1), b = dot(e1, e2), c = dot(e2, e2), d1 = dot(e1, d), d2 = dot(e2, d);
    real determinant = a * c - b * b;
    // A face without area has no plane.
    if (!(determinant > REAL(1e-12) * a * c)) return closest_point_face(x, f0, f1, f2);
    return face_weights((c * d1 - b * d2) / determinant, (a * d2 - b * d1) / determinant);
}

// Weights (1 - s, s, t - 1, -t) of the closest points of the segments p0 p1 and q0 q1.
KERNEL_FN pair_weights closest_edge_edge(vec3 p0, vec3 p1, vec3 q0, vec3 q1)
{
    vec3 u = p1 - p0, v = q1 - q0, r = p0 - q0;
    real a = dot(u, u), e = dot(v, v), f = dot(v, r), c = dot(u, r), b = dot(u, v);
    real determinant = a * e - b * b;
    // The system is singular for parallel segments, here those at an angle with a sine below 1e-6. The point at s = 0
    // is then as good as any other.
    real s = determinant > REAL(1e-12) * a * e ? unit_interval((b * f - c * e) / determinant) : REAL(0);
    real t = (b * s + f) / e;
    if (t < REAL(0)) s = unit_interval(-c / a);
    if (t > REAL(1)) s = unit_interval((b - c) / a);
    t = unit_interval(t);
    pair_weights p;
    p.w[0] = REAL(1) - s;
    p.w[1] = s;
    p.w[2] = t - REAL(1);
    p.w[3] = -t;
    return p;
}
