// Contact with bodies that have a closed-form distance: sphere, plane (a half-space) and capsule (all points within a
// radius of a segment).
//     gap g(x) [m]: signed distance to the surface, negative inside        normal n = grad g, |n| = 1
//     crossing: smallest t in [0, 1] at which x0 + t (x1 - x0) enters the body, or NO_CROSSING
// A path that starts inside never crosses: the shapes are convex, so a straight path cannot enter them again.
// Source: distance functions as in Ericson 2005, Real-Time Collision Detection, sections 5.1 and 5.3.
#pragma once
#include "../portable.h"

#define NO_CROSSING REAL(2)

typedef struct {
    vec3 normal;
    real gap;
} body_contact;

typedef enum { PLANE_SHAPE, SPHERE_SHAPE, CAPSULE_SHAPE } analytic_shape;

// `center` is the sphere's centre, a point of the plane or the capsule's first end; unused members are ignored.
typedef struct {
    analytic_shape shape;
    vec3 center, end, normal;
    real radius;
} analytic_body;

KERNEL_FN body_contact plane_contact(vec3 x, vec3 point, vec3 normal)
{
    body_contact contact;
    contact.normal = normal;
    contact.gap = dot(x - point, normal);
    return contact;
}

KERNEL_FN body_contact sphere_contact(vec3 x, vec3 center, real radius)
{
    vec3 d = x - center;
    real distance = length(d);
    body_contact contact;
    contact.gap = distance - radius;
    contact.normal = make_vec3(REAL(0), REAL(0), REAL(1));  // the centre has no gradient: any unit vector serves
    if (distance > REAL(0)) contact.normal = (REAL(1) / distance) * d;
    return contact;
}

KERNEL_FN body_contact capsule_contact(vec3 x, vec3 first, vec3 last, real radius)
{
    vec3 axis = last - first;
    real along = dot(x - first, axis) / dot(axis, axis);
    along = smaller(REAL(1), larger(REAL(0), along));
    return sphere_contact(x, first + along * axis, radius);
}

KERNEL_FN body_contact analytic_contact(vec3 x, const analytic_body* body)
{
    if (body->shape == PLANE_SHAPE) return plane_contact(x, body->center, body->normal);
    if (body->shape == SPHERE_SHAPE) return sphere_contact(x, body->center, body->radius);
    return capsule_contact(x, body->center, body->end, body->radius);
}

// The parameter t at which a line enters the convex quadric a t^2 + 2 b t + c = 0; the line starts outside, c >= 0.
KERNEL_FN real quadratic_entry(real a, real b, real c)
{
    real discriminant = b * b - a * c;
    if (b >= REAL(0) || a <= REAL(0) || discriminant < REAL(0)) return NO_CROSSING;
    real t = c / (sqrt(discriminant) - b);  // the smaller root, without cancellation
    return t <= REAL(1) ? t : NO_CROSSING;
}

KERNEL_FN real sphere_entry(vec3 x0, vec3 step, vec3 center, real radius)
{
    vec3 d = x0 - center;
    return quadratic_entry(dot(step, step), dot(d, step), dot(d, d) - radius * radius);
}

// Entry into the lateral surface of a capsule: the infinite cylinder, restricted to the part between the two ends.
KERNEL_FN real side_entry(vec3 x0, vec3 step, vec3 first, vec3 last, real radius)
{
    vec3 axis = last - first;
    real inverse_squared_length = REAL(1) / dot(axis, axis);
    vec3 from_first = x0 - first;
    real along0 = dot(from_first, axis) * inverse_squared_length;
    real along_step = dot(step, axis) * inverse_squared_length;
    vec3 d = from_first - along0 * axis;
    vec3 across = step - along_step * axis;
    real c = dot(d, d) - radius * radius;
    if (c < REAL(0)) return NO_CROSSING;  // starts in the cylinder beyond an end: it can enter only that end's sphere
    real t = quadratic_entry(dot(across, across), dot(d, across), c);
    real along = along0 + t * along_step;
    return along >= REAL(0) && along <= REAL(1) ? t : NO_CROSSING;
}

KERNEL_FN real analytic_crossing(vec3 x0, vec3 x1, const analytic_body* body)
{
    vec3 step = x1 - x0;
    real start = analytic_contact(x0, body).gap;
    if (start < REAL(0)) return NO_CROSSING;
    if (body->shape == PLANE_SHAPE) {
        real change = dot(step, body->normal);
        return change < REAL(0) && start + change < REAL(0) ? start / -change : NO_CROSSING;
    }
    real t = sphere_entry(x0, step, body->center, body->radius);
    if (body->shape == CAPSULE_SHAPE) {
        t = smaller(t, sphere_entry(x0, step, body->end, body->radius));
        t = smaller(t, side_entry(x0, step, body->center, body->end, body->radius));
    }
    return t;
}
