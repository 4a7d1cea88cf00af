#include "validation/measure/drape_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace selvage {
namespace {

// The squares of a grid whose middles are covered by a projected face.
struct Raster {
    Vec2 low;
    double cell;
    int columns, rows;
    std::vector<char> covered;

    Raster(const std::vector<Vec3>& positions, double side) : cell(side)
    {
        Vec2 high = low = positions.front().head<2>();
        for (const Vec3& x : positions) {
            low = low.cwiseMin(x.head<2>());
            high = high.cwiseMax(x.head<2>());
        }
        columns = int((high - low).x() / cell) + 2;
        rows = int((high - low).y() / cell) + 2;
        covered.assign(std::size_t(columns) * rows, 0);
    }

    void cover(const Vec2& a, const Vec2& b, const Vec2& c)
    {
        const auto turn = [](const Vec2& p, const Vec2& q, const Vec2& x) {
            return (q - p).x() * (x - p).y() - (q - p).y() * (x - p).x();
        };
        const double sign = turn(a, b, c) < 0 ? -1 : 1;
        const Vec2 first = (a.cwiseMin(b).cwiseMin(c) - low) / cell, last = (a.cwiseMax(b).cwiseMax(c) - low) / cell;
        for (int j = std::max(0, int(first.y()) - 1); j <= std::min(rows - 1, int(last.y()) + 1); ++j)
            for (int i = std::max(0, int(first.x()) - 1); i <= std::min(columns - 1, int(last.x()) + 1); ++i) {
                const Vec2 x = low + cell * Vec2(i + 0.5, j + 0.5);
                if (sign * turn(a, b, x) >= 0 && sign * turn(b, c, x) >= 0 && sign * turn(c, a, x) >= 0)
                    covered[std::size_t(j) * columns + i] = 1;
            }
    }

    bool at(const Vec2& x) const
    {
        const int i = int(std::floor((x.x() - low.x()) / cell)), j = int(std::floor((x.y() - low.y()) / cell));
        return i >= 0 && j >= 0 && i < columns && j < rows && covered[std::size_t(j) * columns + i];
    }
};

// Returns the distance of the outline from the origin at equally spaced angles.
std::vector<double> outline(const Raster& raster)
{
    std::vector<double> radius(720);
    const double reach = raster.cell * std::hypot(raster.columns, raster.rows);
    for (int k = 0; k < int(radius.size()); ++k) {
        const double angle = 2 * std::numbers::pi * k / double(radius.size());
        double r = reach;
        while (r > 0 && !raster.at(r * Vec2(std::cos(angle), std::sin(angle)))) r -= 0.5 * raster.cell;
        radius[k] = r;
    }
    return radius;
}

// Counts the upward crossings of the mean radius. A crossing counts only if it leaves a band around the mean, so that
// small ripples are ignored.
int count_folds(const std::vector<double>& radius)
{
    const auto [least, most] = std::minmax_element(radius.begin(), radius.end());
    double mean = 0;
    for (const double r : radius) mean += r / double(radius.size());
    const double band = 0.1 * (*most - *least);
    int folds = 0;
    bool outside = radius.back() > mean;
    for (int round = 0; round < 2; ++round) {
        folds = 0;  // the first round only finds the value of `outside` with which the second one starts
        for (const double r : radius) {
            if (!outside && r > mean + band) ++folds;
            if (r > mean + band) outside = true;
            if (r < mean - band) outside = false;
        }
    }
    return folds;
}

}  // namespace

DrapeShadow drape_shadow(const std::vector<Vec3>& positions, const std::vector<Face>& faces, double cell)
{
    Raster raster(positions, cell);
    for (const Face& f : faces)
        raster.cover(positions[f[0]].head<2>(), positions[f[1]].head<2>(), positions[f[2]].head<2>());
    const auto count = std::count(raster.covered.begin(), raster.covered.end(), 1);
    return {double(count) * cell * cell, count_folds(outline(raster))};
}

}  // namespace selvage
