#include "host/mesh/convex_hull.hpp"

#include <algorithm>

#include "host/mesh/exact_orientation.hpp"

namespace selvage {
namespace {

// Exact, since sections of meshes have points that nearly lie on each other: rounding would leave inner ones on the
// hull.
bool turns_left(const Vec2& o, const Vec2& a, const Vec2& b)
{
    const auto in_space = [](const Vec2& point, double z) { return Vec3(point.x(), point.y(), z); };
    return exact_orientation(in_space(o, 0), in_space(a, 0), in_space(b, 0), in_space(o, 1)) > 0;
}

}  // namespace

std::vector<Vec2> convex_hull(std::vector<Vec2> points)
{
    std::sort(points.begin(), points.end(),
              [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return points;
    std::vector<Vec2> hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t base = hull.size();
        for (const Vec2& point : points) {
            while (hull.size() > base + 1 && !turns_left(hull[hull.size() - 2], hull.back(), point)) hull.pop_back();
            hull.push_back(point);
        }
        hull.pop_back();  // the first of the next side
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

double perimeter(const std::vector<Vec2>& polygon)
{
    double length = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) length += (polygon[(k + 1) % polygon.size()] - polygon[k]).norm();
    return length;
}

}  // namespace selvage
