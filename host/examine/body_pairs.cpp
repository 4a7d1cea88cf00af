#include "host/examine/body_pairs.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "host/collision/body_query.hpp"

namespace selvage {
namespace {

constexpr double forever = 1e9;           // [s]; after all motion
constexpr std::size_t first_tried = 100;  // vertices; if they lie inside, all are looked at

bool same_surface(const TriangleMesh& a, const TriangleMesh& b)
{
    return a.vertices == b.vertices && a.faces == b.faces;
}

bool is_twin(const Body& a, const Body& b)
{
    if (a.kind != b.kind || bool(a.motion) != bool(b.motion) || !same_surface(a.mesh, b.mesh)) return false;
    return !a.motion || same_surface(body_mesh_at(a, forever), body_mesh_at(b, forever));
}

// A body that others may lie within.
struct Surrounding {
    const Body& body;
    Box box;
    std::optional<BodyQuery> query = {};  // made for the first body that may lie within
};

bool holds(const BodyQuery& query, const std::vector<Vec3>& points)
{
    return std::ranges::all_of(query.signed_distances(points), [](double distance) { return distance < 0; });
}

// Whether a body lies wholly inside another, as both start.
bool lies_within(const Body& inner, const Box& inside, Surrounding& outer)
{
    if (inner.kind == Body::Kind::plane) return false;
    if (outer.body.kind != Body::Kind::plane && !outer.box.contains(inside)) return false;
    if (!outer.query) outer.query.emplace(std::vector<Body>{outer.body}, outer.box);
    const std::vector<Vec3>& points = inner.mesh.vertices;
    std::vector<Vec3> some;
    for (std::size_t k = 0; k < points.size(); k += std::max<std::size_t>(points.size() / first_tried, 1))
        some.push_back(points[k]);
    return holds(*outer.query, some) && holds(*outer.query, points);
}

}  // namespace

std::vector<Finding> examine_body_pairs(const std::vector<Body>& bodies, const std::vector<InputPlace>& places)
{
    std::vector<Finding> findings;
    std::vector<Surrounding> surroundings;
    for (const Body& body : bodies) surroundings.push_back({body, box_of(body.mesh.vertices)});
    for (std::size_t b = 0; b < bodies.size(); ++b)
        for (std::size_t other = 0; other < bodies.size(); ++other) {
            const Body &body = bodies[b], &around = bodies[other];
            if (other < b && is_twin(body, around)) {
                findings.push_back(
                    {"body", places[b],
                     fmt::format("the body `{}` is the same as `{}`, in the same place", body.name, around.name),
                     "remove one of them"});
                break;
            }
            if (other == b || body.motion || around.motion || is_twin(body, around)) continue;
            if (!lies_within(body, surroundings[b].box, surroundings[other])) continue;
            findings.push_back(
                {"body", places[b],
                 fmt::format("the body `{}` lies within `{}`, where no cloth can touch it", body.name, around.name),
                 "remove it, or check its place, unit and size"});
            break;
        }
    return findings;
}

}  // namespace selvage
