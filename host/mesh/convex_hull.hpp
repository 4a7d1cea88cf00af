#pragma once
#include <vector>

#include "io/geometry.hpp"

namespace selvage {

/// Returns the corners of the convex hull of points, counter-clockwise from the one of least x; points on a side are no
/// corners. Source: Andrew 1979 (monotone chain).
std::vector<Vec2> convex_hull(std::vector<Vec2> points);

/// Returns the length of a closed polygon, in the unit of its points.
double perimeter(const std::vector<Vec2>& polygon);

}  // namespace selvage
