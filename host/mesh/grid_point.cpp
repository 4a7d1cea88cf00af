#include "host/mesh/grid_point.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace selvage {
namespace {

constexpr double half_span = 1 << 26;  // grid steps from the middle of the points to the farthest one

// Returns the position of a cell along the Hilbert curve of 2^16 x 2^16 cells, from the coarsest quadrant down.
std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t y)
{
    constexpr std::uint32_t side = 1u << 16;
    std::uint32_t index = 0;
    for (std::uint32_t half = side / 2; half > 0; half /= 2) {
        const std::uint32_t right = (x & half) ? 1 : 0, upper = (y & half) ? 1 : 0;
        index += half * half * ((3 * right) ^ upper);
        if (upper == 0) {
            if (right == 1) {
                x = side - 1 - x;
                y = side - 1 - y;
            }
            std::swap(x, y);
        }
    }
    return index;
}

}  // namespace

bool in_circle(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d)
{
    const double ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
    const double a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
    const double bc = bx * cy - cx * by, ca = cx * ay - ax * cy, ab = ax * by - bx * ay;
    const double determinant = a2 * bc + b2 * ca + c2 * ab;
    const double magnitude = a2 * (std::abs(bx * cy) + std::abs(cx * by)) +
                             b2 * (std::abs(cx * ay) + std::abs(ax * cy)) +
                             c2 * (std::abs(ax * by) + std::abs(bx * ay));
    // The differences are exact, so a bound of (10 + 96 eps) eps would suffice (Shewchuk 1997); this one is larger.
    if (std::abs(determinant) > 2e-15 * magnitude) return determinant > 0;

    __extension__ using Wide = __int128;  // differences have 30 bits, so the determinant stays below 2^124
    const auto squared = [](double x, double y) { return Wide(x) * Wide(x) + Wide(y) * Wide(y); };
    const auto cross = [](double ux, double uy, double vx, double vy) {
        return Wide(ux) * Wide(vy) - Wide(vx) * Wide(uy);
    };
    return squared(ax, ay) * cross(bx, by, cx, cy) + squared(bx, by) * cross(cx, cy, ax, ay) +
               squared(cx, cy) * cross(ax, ay, bx, by) >
           0;
}

GridMap::GridMap(const std::vector<Vec2>& points)
{
    Vec2 low = points.front(), high = points.front();
    for (const Vec2& point : points) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    middle_ = 0.5 * (low + high);
    const double extent = 0.5 * (high - low).maxCoeff();
    step_ = extent > 0 ? extent / half_span : 1;
}

GridPoint GridMap::to_grid(const Vec2& point) const
{
    const Vec2 steps = (point - middle_) / step_;
    return {int(std::lround(steps.x())), int(std::lround(steps.y()))};
}

Vec2 GridMap::to_plane(const GridPoint& point) const { return middle_ + step_ * Vec2(point.x, point.y); }

std::vector<int> hilbert_order(const std::vector<GridPoint>& points)
{
    if (points.empty()) return {};
    GridPoint low = points.front(), high = points.front();
    for (const GridPoint& point : points) {
        low = {std::min(low.x, point.x), std::min(low.y, point.y)};
        high = {std::max(high.x, point.x), std::max(high.y, point.y)};
    }
    const double extent = std::max({high.x - low.x, high.y - low.y, 1});
    std::vector<std::pair<std::uint32_t, int>> keys;
    keys.reserve(points.size());
    for (const GridPoint& point : points)
        keys.emplace_back(hilbert_index(std::uint32_t(65535.0 * (point.x - low.x) / extent),
                                        std::uint32_t(65535.0 * (point.y - low.y) / extent)),
                          int(keys.size()));
    std::sort(keys.begin(), keys.end());
    std::vector<int> order;
    order.reserve(points.size());
    for (const auto& [key, index] : keys) order.push_back(index);
    return order;
}

}  // namespace selvage
