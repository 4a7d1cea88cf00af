#include "host/collision/thin_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>

#include "host/collision/body_query.hpp"
#include "host/parallel/launch.hpp"

namespace selvage {
namespace {

// How a body is made thin and grows. The first four are those of a study of 23 patterns on three bodies.
struct ThinTuning {
    static constexpr double largest_radius = 0.3;  // of a ball [m]: half of a broad chest's width and more
    static constexpr int ball_rounds = 60;         // of shrinking; most balls need fewer than ten
    static constexpr int limit_rounds = 5;         // in which radii are cut to their surroundings'
    static constexpr int smooth_rounds = 8;        // of radii, and as many of ways
    static constexpr double limit = 1.02;          // times the mean radius around
    static constexpr double touching = 1e-4;       // [m]: a ball that holds nothing deeper is free
    // What sticks out of something far thicker, as ears do, moves along with it: radii below this part of the largest
    // one within that distance [m]. Ears are thinner by 10 than heads, arms by 3 than chests, fingers by 2 than hands.
    static constexpr double sticks_out = 0.25, beside = 0.04;
    static constexpr int carry_rounds = 50;  // of smoothing how what sticks out moves
    // Part of the way back and of the time at which a growing body is there: slow near the end, where cloth is tight.
    static constexpr std::array<std::array<double, 2>, 3> pace = {{{0.5, 0.3}, {0.8, 0.6}, {1.0, 1.0}}};
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

// The points of a mesh: its vertices, those at one place being one, with their normals and neighbours.
struct Surface {
    std::vector<int> point_of;  // vertex to point
    std::vector<Vec3> points, normals;
    std::vector<int> begin, ring;  // neighbours of each point
};

void find_points(const TriangleMesh& mesh, Surface& surface)
{
    std::map<std::array<double, 3>, int> known;
    for (const Vec3& x : mesh.vertices) {
        const auto [at, is_new] = known.try_emplace({x.x(), x.y(), x.z()}, int(surface.points.size()));
        if (is_new) surface.points.push_back(x);
        surface.point_of.push_back(at->second);
    }
}

Surface surface_of(const TriangleMesh& mesh)
{
    Surface surface;
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

// Radius of the largest ball within that touches each point.
std::vector<double> ball_radii(const Surface& surface, const PointTree& tree)
{
    std::vector<double> radii(surface.points.size());
    for_each_item(int(radii.size()), [&, to = radii.data()](int k) {
        const Vec3 &x = surface.points[k], &normal = surface.normals[k];
        double radius = ThinTuning::largest_radius;
        for (int round = 0; round < ThinTuning::ball_rounds; ++round) {
            const Vec3 center = x - radius * normal;
            const int nearest = tree.nearest(center);
            if (nearest == k || (surface.points[nearest] - center).norm() >= radius - ThinTuning::touching) break;
            const Vec3 way = x - surface.points[nearest];
            const double across = 2 * normal.dot(way);
            if (!(across > 0) || way.squaredNorm() >= radius * across) break;
            radius = way.squaredNorm() / across;
        }
        to[k] = radius;
    });
    return radii;
}

// Replaces each value, or those that are marked, by what `blend` makes of it and the mean around it.
template <class Value, class Blend>
void smooth(const Surface& surface, std::vector<Value>& values, int rounds, const Blend& blend,
            const std::vector<char>* marked = nullptr)
{
    std::vector<Value> next = values;
    for (int round = 0; round < rounds; ++round) {
        for_each_item(int(values.size()), [&, to = next.data(), from = values.data()](int k) {
            const int first = surface.begin[k], last = surface.begin[k + 1];
            if (first == last || (marked && !(*marked)[k])) return;
            Value mean = from[surface.ring[first]];
            for (int i = first + 1; i < last; ++i) mean += from[surface.ring[i]];
            to[k] = blend(from[k], Value(mean / double(last - first)));
        });
        values.swap(next);
    }
}

std::vector<char> points_that_stick_out(const Surface& surface, const PointTree& tree, const std::vector<double>& radii)
{
    std::vector<char> marked(radii.size());
    for_each_item(int(radii.size()), [&, to = marked.data()](int k) {
        double largest = 0;
        tree.within(surface.points[k], ThinTuning::beside,
                    [&](int other) { largest = std::max(largest, radii[other]); });
        to[k] = radii[k] < ThinTuning::sticks_out * largest;
    });
    return marked;
}

// Gives marked points the values of the nearest others along the surface, and smooths those.
template <class Value>
void take_from_around(const Surface& surface, const std::vector<char>& marked, std::vector<Value>& values)
{
    std::vector<char> waits = marked;
    std::vector<int> front;
    for (int k = 0; k < int(values.size()); ++k)
        if (!waits[k]) front.push_back(k);
    while (!front.empty()) {
        std::vector<int> next;
        for (int k : front)
            for (int i = surface.begin[k]; i < surface.begin[k + 1]; ++i) {
                const int other = surface.ring[i];
                if (!waits[other]) continue;
                waits[other] = 0;
                values[other] = values[k];
                next.push_back(other);
            }
        front.swap(next);
    }
    smooth(
        surface, values, ThinTuning::carry_rounds, [](const Value&, const Value& mean) { return mean; }, &marked);
}

}  // namespace

std::vector<Vec3> thin_vertices(const TriangleMesh& mesh, double part)
{
    const Surface surface = surface_of(mesh);
    const PointTree tree(surface.points);
    std::vector<double> radii = ball_radii(surface, tree);
    const std::vector<char> sticks_out = points_that_stick_out(surface, tree, radii);
    take_from_around(surface, sticks_out, radii);
    smooth(surface, radii, ThinTuning::limit_rounds,
           [](double own, double mean) { return std::min(own, ThinTuning::limit * mean); });
    smooth(surface, radii, ThinTuning::smooth_rounds, [](double own, double mean) { return 0.5 * (own + mean); });
    std::vector<Vec3> ways(radii.size());
    for (std::size_t k = 0; k < ways.size(); ++k) ways[k] = -radii[k] * surface.normals[k];
    take_from_around(surface, sticks_out, ways);
    smooth(surface, ways, ThinTuning::smooth_rounds,
           [](const Vec3& own, const Vec3& mean) { return Vec3(0.5 * (own + mean)); });
    std::vector<Vec3> vertices = mesh.vertices;
    for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] += part * ways[surface.point_of[v]];
    return vertices;
}

std::vector<Body> thin_bodies(const std::vector<Body>& bodies, double part)
{
    std::vector<Body> thin = bodies;
    for (Body& body : thin) {
        body.motion.reset();
        if (part > 0 && body.kind == Body::Kind::mesh) body.mesh.vertices = thin_vertices(body.mesh, part);
    }
    return thin;
}

std::vector<Body> growing_bodies(const std::vector<Body>& thin, const std::vector<Body>& whole, double start,
                                 double length)
{
    std::vector<Body> bodies = thin;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (bodies[b].kind != Body::Kind::mesh) continue;
        const std::vector<Vec3>&from = thin[b].mesh.vertices, &to = whole[b].mesh.vertices;
        auto motion = std::make_shared<BodyMotion>(std::vector<MotionKey>{}, false, Vec3::Zero());
        motion->add_pose(0, from, false);
        if (start > 0) motion->add_pose(start, from, false);
        for (const auto& [part, time] : ThinTuning::pace) {
            std::vector<Vec3> vertices = to;
            if (part < 1)
                for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = from[v] + part * (to[v] - from[v]);
            motion->add_pose(start + time * length, std::move(vertices), false);
        }
        bodies[b].motion = std::move(motion);
    }
    return bodies;
}

bool seams_meet_bodies(const Cloth& cloth, const std::vector<Body>& bodies)
{
    std::vector<Body> meshes;
    for (const Body& body : bodies)
        if (body.kind == Body::Kind::mesh) meshes.push_back(body);
    for (Body& body : meshes) body.motion.reset();
    std::vector<Vec3> ends[2];
    for (const auto& pair : cloth.seam_pairs)
        for (int k = 0; k < 2 && cloth.positions[pair[0]] != cloth.positions[pair[1]]; ++k)
            ends[k].push_back(cloth.positions[pair[k]]);
    const int count = int(ends[0].size());
    if (meshes.empty() || count == 0) return false;
    std::vector<double> planes[2];
    for (int k = 0; k < 2; ++k)
        for (int c = 0; c < 3; ++c)
            for (const Vec3& x : ends[k]) planes[k].push_back(x[c]);
    BodyQuery query(meshes, box_of(cloth.positions));
    const std::vector<BodyCrossing> entries = query.crossings(planes[0].data(), planes[1].data(), count, count);
    const std::vector<double> distances = query.signed_distances(ends[0]);
    return std::any_of(entries.begin(), entries.end(), [](const BodyCrossing& entry) { return entry.body >= 0; }) ||
           std::any_of(distances.begin(), distances.end(), [](double distance) { return distance < 0; });
}

}  // namespace selvage
