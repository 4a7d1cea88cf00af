#include "host/mesh/polygon_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include <Eigen/Geometry>

namespace selvage {
namespace {

constexpr double flat = 1e-6;      // of the extent; files of six digits are off their plane by less
constexpr double no_area = 1e-12;  // of the squared extent: within the rounding error of its computation
constexpr double near = 1e-6;      // of the squared extent: a corner so near an ear would leave a sliver behind it
constexpr double no_turn = 1e-9;   // sine of the angle below which three corners count as on one line

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// A polygon in the plane of its area vector, counter-clockwise there.
struct FlatPolygon {
    std::vector<Vec2> points;
    double extent = 0;
    bool has_area = false, is_flat = true;
};

FlatPolygon flattened(const std::vector<Vec3>& vertices, std::span<const int> polygon)
{
    const auto at = [&](std::size_t k) { return vertices[polygon[k]] - vertices[polygon[0]]; };
    Vec3 area = Vec3::Zero(), low = Vec3::Zero(), high = Vec3::Zero();
    for (std::size_t k = 1; k < polygon.size(); ++k) {
        if (k + 1 < polygon.size()) area += 0.5 * at(k).cross(at(k + 1));
        low = low.cwiseMin(at(k));
        high = high.cwiseMax(at(k));
    }
    FlatPolygon result;
    result.extent = (high - low).maxCoeff();
    result.has_area = area.norm() > no_area * result.extent * result.extent;
    if (!result.has_area) return result;
    const Vec3 normal = area.normalized(), across = normal.unitOrthogonal(), up = normal.cross(across);
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        result.points.emplace_back(at(k).dot(across), at(k).dot(up));
        result.is_flat = result.is_flat && std::abs(at(k).dot(normal)) <= flat * result.extent;
    }
    return result;
}

// Every corner turns left, and so does every triangle of the fan, which leaves out stars.
bool is_convex(const std::vector<Vec2>& points)
{
    const std::size_t count = points.size();
    const auto turns_left = [&](std::size_t a, std::size_t b, std::size_t c) {
        const Vec2 one = points[b] - points[a], two = points[c] - points[b];
        return cross(one, two) > no_turn * one.norm() * two.norm();
    };
    for (std::size_t k = 0; k < count; ++k) {
        if (!turns_left(k, (k + 1) % count, (k + 2) % count)) return false;
        if (k > 0 && k + 1 < count && !turns_left(0, k, k + 1)) return false;
    }
    return true;
}

// Ear clipping over a ring of the corners that are left, with the ears sorted by shape.
class EarClipping {
public:
    EarClipping(const FlatPolygon& polygon, std::vector<std::array<int, 3>>& triangles)
        : points_(polygon.points), least_area_(no_area * polygon.extent * polygon.extent),
          margin_(near * polygon.extent * polygon.extent), triangles_(triangles)
    {
    }

    bool run();

private:
    void measure(int corner);
    double doubled_area(int a, int b, int c) const { return cross(points_[b] - points_[a], points_[c] - points_[a]); }
    bool holds_another(int corner) const;

    const std::vector<Vec2>& points_;
    double least_area_, margin_;
    std::vector<std::array<int, 3>>& triangles_;
    int start_ = 0;  ///< A corner that is left.
    std::vector<int> next_, previous_;
    std::vector<double> shape_;              ///< Of the ear at each corner: at most 0 if it is none.
    std::set<std::pair<double, int>> ears_;  ///< By falling shape, then by corner.
};

bool EarClipping::holds_another(int corner) const
{
    const int a = previous_[corner], c = next_[corner];
    for (int p = next_[c]; p != a; p = next_[p])
        if (std::min({doubled_area(a, corner, p), doubled_area(corner, c, p), doubled_area(c, a, p)}) >= -margin_)
            return true;
    return false;
}

void EarClipping::measure(int corner)
{
    ears_.erase({-shape_[corner], corner});
    const int a = previous_[corner], c = next_[corner];
    const double area = doubled_area(a, corner, c);
    const double longest =
        std::max({(points_[corner] - points_[a]).squaredNorm(), (points_[c] - points_[corner]).squaredNorm(),
                  (points_[a] - points_[c]).squaredNorm()});
    shape_[corner] = area > least_area_ && !holds_another(corner) ? area / longest : 0;
    if (shape_[corner] > 0) ears_.emplace(-shape_[corner], corner);
}

bool EarClipping::run()
{
    const int count = int(points_.size());
    const std::size_t before = triangles_.size();
    next_.resize(count);
    previous_.resize(count);
    shape_.assign(count, 0);
    for (int k = 0; k < count; ++k) {
        next_[k] = (k + 1) % count;
        previous_[k] = (k + count - 1) % count;
    }
    for (int k = 0; k < count; ++k) measure(k);
    for (int left = count; left > 2; --left) {
        // Clipping changes the ears beside it only, but for corners that lie on the sides of others or near them.
        if (ears_.empty()) margin_ = least_area_;
        if (ears_.empty())
            for (int k = next_[start_], n = 0; n < left; k = next_[k], ++n) measure(k);
        if (ears_.empty()) {
            triangles_.resize(before);
            return false;
        }
        const int tip = ears_.begin()->second, a = previous_[tip], c = next_[tip];
        ears_.erase(ears_.begin());
        triangles_.push_back({a, tip, c});
        start_ = a;
        next_[a] = c;
        previous_[c] = a;
        if (left == 3) break;
        measure(a);
        measure(c);
    }
    return true;
}

}  // namespace

bool split_polygon(const std::vector<Vec3>& vertices, std::span<const int> polygon,
                   std::vector<std::array<int, 3>>& triangles)
{
    const int count = int(polygon.size());
    if (count == 3) {
        triangles.push_back({0, 1, 2});
        return true;
    }
    const FlatPolygon given = flattened(vertices, polygon);
    if (!given.has_area) return false;
    if (given.is_flat && is_convex(given.points)) {
        for (int k = 2; k < count; ++k) triangles.push_back({0, k - 1, k});
        return true;
    }
    // From its smallest vertex on, so that no rounding error depends on where the polygon begins.
    const int start = int(std::min_element(polygon.begin(), polygon.end()) - polygon.begin());
    std::vector<int> turned(polygon.begin() + start, polygon.end());
    turned.insert(turned.end(), polygon.begin(), polygon.begin() + start);
    const std::size_t first = triangles.size();
    if (!EarClipping(flattened(vertices, turned), triangles).run()) return false;
    for (std::size_t t = first; t < triangles.size(); ++t)
        for (int& corner : triangles[t]) corner = (corner + start) % count;
    return true;
}

TriangleMesh triangle_mesh(const ObjMesh& obj)
{
    TriangleMesh mesh;
    mesh.vertices = obj.vertices;
    std::vector<std::array<int, 3>> triangles;
    for (int p = 0; p < obj.polygon_count(); ++p) {
        triangles.clear();
        const std::span<const int> polygon = obj.polygon(p);
        split_polygon(mesh.vertices, polygon, triangles);
        for (const auto& [a, b, c] : triangles) mesh.faces.push_back({polygon[a], polygon[b], polygon[c]});
    }
    return mesh;
}

}  // namespace selvage
