#include "host/collision/thin_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "host/collision/body_query.hpp"
#include "host/collision/surface_points.hpp"

namespace selvage {
namespace {

// How a body is made thin and grows. The first three are those of a study of 23 patterns on three bodies.
struct ThinTuning {
    static constexpr int limit_rounds = 5;   // in which radii are cut to their surroundings'
    static constexpr int smooth_rounds = 8;  // of radii, and as many of ways
    static constexpr double limit = 1.02;    // times the mean radius around
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
