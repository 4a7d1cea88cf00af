#pragma once
#include <vector>

#include "io/geometry.hpp"

namespace selvage {

/// A point of the integer grid on which all geometric tests are exact; |x|, |y| <= 2^28.
struct GridPoint {
    int x = 0, y = 0;
    bool operator==(const GridPoint&) const = default;
};

/// Returns twice the signed area of the triangle abc, exactly; positive if counter-clockwise.
inline long long doubled_area(const GridPoint& a, const GridPoint& b, const GridPoint& c)
{
    const long long ux = b.x - a.x, uy = b.y - a.y, vx = c.x - a.x, vy = c.y - a.y;
    return ux * vy - uy * vx;
}

/// Returns whether d lies strictly inside the circle through the counter-clockwise triangle abc; exact.
bool in_circle(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d);

/// Maps plane coordinates [m] to the grid and back.
class GridMap {
public:
    /// @param points  at least one; they span at most 2^26 grid steps to each side of their middle
    explicit GridMap(const std::vector<Vec2>& points);
    GridPoint to_grid(const Vec2& point) const;
    Vec2 to_plane(const GridPoint& point) const;
    double step() const { return step_; }  ///< Grid step [m].

private:
    Vec2 middle_;
    double step_;
};

/// Returns the indices of the points along a Hilbert curve, so that points close in the order are close in the plane.
std::vector<int> hilbert_order(const std::vector<GridPoint>& points);

}  // namespace selvage
