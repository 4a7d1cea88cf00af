#pragma once
#include <array>

#include "io/geometry.hpp"

namespace selvage {

using Triangle = std::array<Vec3, 3>;

/// True if the corners lie on one line.
bool is_degenerate(const Triangle& t);

/// True if a closed segment and a closed triangle with an area have a point in common; exact.
bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Triangle& t);

/// True if two closed triangles with areas have a point in common, be it a corner on a face or an overlap in one plane;
/// exact. Two triangles meet exactly where an edge of one meets the other.
bool triangles_meet(const Triangle& a, const Triangle& b);

}  // namespace selvage
