#include "host/collision/surface_points.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>

namespace selvage {
namespace {

// How balls and what sticks out are found.
struct SurfaceTuning {
    static constexpr double largest_radius = 0.3;  // of a ball [m]: half of a broad chest's width and more
    static constexpr int ball_rounds = 60;         // of shrinking; most balls need fewer than ten
    static constexpr double touching = 1e-4;       // [m]: a ball that holds nothing deeper is free
    // What sticks out of something far thicker, as ears do: radii below this part of the largest one within that
    // distance [m]. Ears are thinner by 10 than heads, arms by 3 than chests, fingers by 2 than hands.
    static constexpr double sticks_out = 0.25, beside = 0.04;
};

// Points for queries of the nearest one: a balanced tree in an array, split along x, y and z in turn.
class PointTree {
public:
    explicit PointTree(const std::vector<Vec3>& points) : points_(points), order_(points.size())
    {
        std::iota(order_.begin(), order_.end(), 0);
        sort(0, int(order_.size()), 0);
    }

    // The nearest point, -1 without any.
    int nearest(const Vec3& x) const
    {
        Best best;
        search(x, 0, int(order_.size()), 0, best);
        return best.point;
    }

    // Calls with each point within a distance of x.
    template <class Hear>
    void within(const Vec3& x, double radius, const Hear& hear) const
    {
        collect(x, radius, 0, int(order_.size()), 0, hear);
    }

private:
    struct Best {
        int point = -1;
        double squared = std::numeric_limits<double>::infinity();
    };

    void sort(int first, int last, int axis)
    {
        if (last - first < 2) return;
        const int middle = (first + last) / 2;
        std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                         [&](int a, int b) { return std::pair(points_[a][axis], a) < std::pair(points_[b][axis], b); });
        sort(first, middle, (axis + 1) % 3);
        sort(middle + 1, last, (axis + 1) % 3);
    }

    template <class Hear>
    void collect(const Vec3& x, double radius, int first, int last, int axis, const Hear& hear) const
    {
        if (first >= last) return;
        const int middle = (first + last) / 2, point = order_[middle];
        const double beyond = x[axis] - points_[point][axis];
        if ((points_[point] - x).squaredNorm() <= radius * radius) hear(point);
        if (beyond <= radius) collect(x, radius, first, middle, (axis + 1) % 3, hear);
        if (beyond >= -radius) collect(x, radius, middle + 1, last, (axis + 1) % 3, hear);
    }

    void search(const Vec3& x, int first, int last, int axis, Best& best) const
    {
        if (first >= last) return;
        const int middle = (first + last) / 2, point = order_[middle];
        const double squared = (points_[point] - x).squaredNorm(), beyond = x[axis] - points_[point][axis];
        if (squared < best.squared || (squared == best.squared && point < best.point)) best = {point, squared};
        const int next = (axis + 1) % 3;
        const bool below = beyond < 0;
        search(x, below ? first : middle + 1, below ? middle : last, next, best);
        if (beyond * beyond <= best.squared) search(x, below ? middle + 1 : first, below ? last : middle, next, best);
    }

    const std::vector<Vec3>& points_;
    std::vector<int> order_;
};

void find_points(const TriangleMesh& mesh, SurfacePoints& surface)
{
    std::map<std::array<double, 3>, int> known;
    for (const Vec3& x : mesh.vertices) {
        const auto [at, is_new] = known.try_emplace({x.x(), x.y(), x.z()}, int(surface.points.size()));
        if (is_new) surface.points.push_back(x);
        surface.point_of.push_back(at->second);
    }
}

}  // namespace

SurfacePoints surface_points(const TriangleMesh& mesh)
{
    SurfacePoints surface;
    find_points(mesh, surface);
    surface.normals.assign(surface.points.size(), Vec3::Zero());
    std::vector<std::array<int, 2>> edges;
    for (const Face& face : mesh.faces) {
        const Face f = {surface.point_of[face[0]], surface.point_of[face[1]], surface.point_of[face[2]]};
        const Vec3 &a = surface.points[f[0]], &b = surface.points[f[1]], &c = surface.points[f[2]];
        const Vec3 normal = (b - a).cross(c - a);
        for (int k = 0; k < 3; ++k) {
            surface.normals[f[k]] += normal;
            edges.push_back({f[k], f[(k + 1) % 3]});
            edges.push_back({f[(k + 1) % 3], f[k]});
        }
    }
    for (Vec3& normal : surface.normals) normal /= std::max(normal.norm(), 1e-300);
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    surface.begin.assign(surface.points.size() + 1, 0);
    for (const auto& [from, to] : edges) {
        ++surface.begin[from + 1];
        surface.ring.push_back(to);
    }
    std::partial_sum(surface.begin.begin(), surface.begin.end(), surface.begin.begin());
    return surface;
}

namespace {

// Radius of the largest ball within that touches each point.
std::vector<double> ball_radii(const SurfacePoints& surface, const PointTree& tree)
{
    std::vector<double> radii(surface.points.size());
    for_each_item(int(radii.size()), [&, to = radii.data()](int k) {
        const Vec3 &x = surface.points[k], &normal = surface.normals[k];
        double radius = SurfaceTuning::largest_radius;
        for (int round = 0; round < SurfaceTuning::ball_rounds; ++round) {
            const Vec3 center = x - radius * normal;
            const int nearest = tree.nearest(center);
            if (nearest == k || (surface.points[nearest] - center).norm() >= radius - SurfaceTuning::touching) break;
            const Vec3 way = x - surface.points[nearest];
            const double across = 2 * normal.dot(way);
            if (!(across > 0) || way.squaredNorm() >= radius * across) break;
            radius = way.squaredNorm() / across;
        }
        to[k] = radius;
    });
    return radii;
}

std::vector<char> points_that_stick_out(const SurfacePoints& surface, const PointTree& tree,
                                        const std::vector<double>& radii)
{
    std::vector<char> marked(radii.size());
    for_each_item(int(radii.size()), [&, to = marked.data()](int k) {
        double largest = 0;
        tree.within(surface.points[k], SurfaceTuning::beside,
                    [&](int other) { largest = std::max(largest, radii[other]); });
        to[k] = radii[k] < SurfaceTuning::sticks_out * largest;
    });
    return marked;
}

}  // namespace

Thickness thickness_of(const SurfacePoints& surface)
{
    const PointTree tree(surface.points);
    Thickness result;
    result.radii = ball_radii(surface, tree);
    result.sticks_out = points_that_stick_out(surface, tree, result.radii);
    take_from_around(surface, result.sticks_out, result.radii);
    return result;
}

}  // namespace selvage
