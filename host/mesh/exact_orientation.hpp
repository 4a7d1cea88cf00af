#pragma once
#include "io/geometry.hpp"

namespace selvage {

/// Returns on which side of the plane through a, b, c a point d lies: the exact sign of (b - a) x (c - a) . (d - a).
/// Determinants too small for double precision are summed exactly. Source: Shewchuk 1997, Adaptive precision
/// floating-point arithmetic and fast robust geometric predicates.
/// @returns 1, 0 or -1
int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace selvage
