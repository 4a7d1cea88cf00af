#pragma once
#include <vector>

#include "io/geometry.hpp"

namespace selvage {

/// Which side of the line from the first to the last point of a curve, seen from the first.
enum class BendSide { left, right };

/// The bend of a curve: what lies furthest on one side of the line from its first to its last point.
struct Bend {
    int point = -1;    ///< Index of the furthest point; -1: none lies on that side.
    int middle = -1;   ///< Of the points around it that are nearly as far: less moved by noise where the bend is round.
    double depth = 0;  ///< Distance of the furthest point from the line.
};

Bend find_bend(const std::vector<Vec2>& curve, BendSide side);

}  // namespace selvage
