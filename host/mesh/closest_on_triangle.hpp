#pragma once
#include "io/geometry.hpp"

namespace selvage {

/// The part of a triangle on which a closest point lies.
enum class TriangleFeature { face, edge, corner };

struct ClosestOnTriangle {
    Vec3 point;
    Vec3 weights;  ///< Barycentric coordinates of `point`.
    TriangleFeature feature = TriangleFeature::face;
    int local = 0;  ///< The corner, or the corner at which the edge starts (counter-clockwise).
    double squared_distance = 0;
};

/// Returns the point of the triangle abc closest to x; abc must have an area above zero.
/// Source: Ericson 2005, Real-Time Collision Detection, section 5.1.5 (Voronoi regions of the triangle).
inline ClosestOnTriangle closest_on_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
    const auto result = [&](const Vec3& weights, TriangleFeature feature, int local) {
        const Vec3 offset = weights.y() * ab + weights.z() * ac;
        return ClosestOnTriangle{a + offset, weights, feature, local, (ax - offset).squaredNorm()};
    };
    const double ab_a = ab.dot(ax), ac_a = ac.dot(ax);
    if (ab_a <= 0 && ac_a <= 0) return result({1, 0, 0}, TriangleFeature::corner, 0);
    const double ab_b = ab.dot(bx), ac_b = ac.dot(bx);
    if (ab_b >= 0 && ac_b <= ab_b) return result({0, 1, 0}, TriangleFeature::corner, 1);
    const double ab_c = ab.dot(cx), ac_c = ac.dot(cx);
    if (ac_c >= 0 && ab_c <= ac_c) return result({0, 0, 1}, TriangleFeature::corner, 2);

    const double area_c = ab_a * ac_b - ab_b * ac_a;
    if (area_c <= 0 && ab_a >= 0 && ab_b <= 0) {
        const double t = ab_a / (ab_a - ab_b);
        return result({1 - t, t, 0}, TriangleFeature::edge, 0);
    }
    const double area_a = ab_b * ac_c - ab_c * ac_b, to_c = ac_b - ab_b, to_b = ab_c - ac_c;
    if (area_a <= 0 && to_c >= 0 && to_b >= 0) {
        const double t = to_c / (to_c + to_b);
        return result({0, 1 - t, t}, TriangleFeature::edge, 1);
    }
    const double area_b = ab_c * ac_a - ab_a * ac_c;
    if (area_b <= 0 && ac_a >= 0 && ac_c <= 0) {
        const double t = ac_a / (ac_a - ac_c);
        return result({1 - t, 0, t}, TriangleFeature::edge, 2);
    }
    const double scale = 1 / (area_a + area_b + area_c);
    return result({area_a * scale, area_b * scale, area_c * scale}, TriangleFeature::face, 0);
}

}  // namespace selvage
