#include "host/collision/thin_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "host/collision/body_query.hpp"
#include "host/collision/surface_points.hpp"

namespace selvage {
namespace {

// How a body is made thin and grows. The first three are those of a study of 23 patterns on three bodies.
struct ThinTuning {
    static constexpr int limit_rounds = 5;   // in which radii are cut to their surroundings'
    static constexpr int smooth_rounds = 8;  // of radii, and as many of ways
    static constexpr double limit = 1.02;    // times the mean radius around
    // How thin bodies are lowered, in steps [m]: straps on shoulders need 1 to 3.
    static constexpr double lower_step = 0.01;
    static constexpr int most_lower_steps = 5;
    // Part of the way back and of the time at which a growing body is there: slow near the end, where cloth is tight.
    static constexpr std::array<std::array<double, 2>, 3> pace = {{{0.5, 0.3}, {0.8, 0.6}, {1.0, 1.0}}};
};

}  // namespace

std::vector<Vec3> thin_vertices(const TriangleMesh& mesh, double part)
{
    const SurfacePoints surface = surface_points(mesh);
    auto [radii, sticks_out] = thickness_of(surface);
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

namespace {

// Stitched pairs of a cloth that start apart, among the bodies of meshes.
class PairsAmongBodies {
public:
    PairsAmongBodies(const Cloth& cloth, std::vector<Body> bodies) : cloth_(cloth)
    {
        std::erase_if(bodies, [](const Body& body) { return body.kind != Body::Kind::mesh; });
        for (Body& body : bodies) body.motion.reset();
        for (const auto& [a, b] : cloth.seam_pairs)
            if (cloth.positions[a] != cloth.positions[b]) pairs_.push_back({a, b});
        if (!bodies.empty() && !pairs_.empty()) query_.emplace(bodies, box_of(cloth.positions));
    }

    bool none() const { return !query_; }

    // Which pairs have a body between them or are inside one while bodies are lower by so much [m].
    std::vector<char> blocked(double lower)
    {
        const int count = int(pairs_.size());
        std::vector<double> planes[2];
        std::vector<Vec3> ends[2];
        for (int k = 0; k < 2; ++k) {
            for (const auto& pair : pairs_) ends[k].push_back(cloth_.positions[pair[k]] + lower * Vec3::UnitZ());
            for (int c = 0; c < 3; ++c)
                for (const Vec3& x : ends[k]) planes[k].push_back(x[c]);
        }
        const std::vector<BodyCrossing> entries = query_->crossings(planes[0].data(), planes[1].data(), count, count);
        const std::vector<double> distances = query_->signed_distances(ends[0]);
        std::vector<char> result(pairs_.size());
        for (std::size_t k = 0; k < result.size(); ++k) result[k] = entries[k].body >= 0 || distances[k] < 0;
        return result;
    }

private:
    const Cloth& cloth_;
    std::vector<std::array<int, 2>> pairs_;
    std::optional<BodyQuery> query_;
};

std::ptrdiff_t count_of(const std::vector<char>& marked) { return std::count(marked.begin(), marked.end(), 1); }

}  // namespace

bool seams_meet_bodies(const Cloth& cloth, const std::vector<Body>& bodies)
{
    PairsAmongBodies pairs(cloth, bodies);
    return !pairs.none() && count_of(pairs.blocked(0)) > 0;
}

std::vector<Body> lowered_bodies(const std::vector<Body>& bodies, const Cloth& cloth)
{
    PairsAmongBodies pairs(cloth, bodies);
    if (pairs.none()) return bodies;
    const std::vector<char> at_first = pairs.blocked(0);
    std::ptrdiff_t fewest = count_of(at_first);
    int first = 0, last = 0;
    for (int step = 1; step <= ThinTuning::most_lower_steps && count_of(at_first) > 0; ++step) {
        const std::vector<char> now = pairs.blocked(step * ThinTuning::lower_step);
        bool comes_between = false;
        for (std::size_t k = 0; k < now.size(); ++k) comes_between = comes_between || (now[k] && !at_first[k]);
        const std::ptrdiff_t count = count_of(now);
        if (comes_between) break;
        if (count < fewest) first = step;
        if (count <= fewest) last = step;
        fewest = std::min(fewest, count);
    }
    const Vec3 way(0, 0, -ThinTuning::lower_step * ((first + last + 1) / 2));
    std::vector<Body> lowered = bodies;
    for (Body& body : lowered)
        if (body.kind == Body::Kind::mesh)
            for (Vec3& x : body.mesh.vertices) x += way;
    return lowered;
}

}  // namespace selvage
