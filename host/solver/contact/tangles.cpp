#include "host/solver/contact/tangles.hpp"

#include <algorithm>

#include "host/parallel/launch.hpp"

namespace selvage {

Tangles::Tangles(std::vector<Face> faces, int particle_count, const std::vector<Body>& bodies)
    : faces_(std::move(faces)), bodies_(bodies), flags_(std::size_t(particle_count))
{
}

void Tangles::find(const State& state, const TreeBodies& body_corners)
{
    std::fill(flags_.inside.begin(), flags_.inside.end(), 1);
    find_inside(state);
    find_intersections(state, body_corners);
}

void Tangles::update(const State& state, const TreeBodies& body_corners)
{
    if (tangle_count_ > 0) find_intersections(state, body_corners);
    if (inside_count_ > 0) find_inside(state);
}

// A vertex that has been outside is never marked again: the contact plane of another face may lie above it.
void Tangles::find_inside(const State& state)
{
    if (bodies_.empty() || state.contact_offset.empty()) {
        std::fill(flags_.inside.begin(), flags_.inside.end(), 0);
        return;
    }
    const int vs = state.size.vertex_stride;
    inside_count_ = int(sum_items(state.size.vertex_count, [&inside = flags_.inside, &state, vs](int v) {
        double along = -state.contact_offset[v];
        for (int c = 0; c < 3; ++c) along += state.contact_normal[c * vs + v] * state.pos[c * vs + v];
        inside[v] = inside[v] && along < 0;
        return inside[v] ? 1.0 : 0.0;
    }));
}

void Tangles::find_intersections(const State& state, const TreeBodies& body_corners)
{
    const int n = state.size.vertex_count, vs = state.size.vertex_stride;
    std::vector<Vec3> x(static_cast<std::size_t>(n));
    for (int v = 0; v < n; ++v) x[v] = {state.pos[v], state.pos[vs + v], state.pos[2 * vs + v]};
    std::fill(flags_.tangled.begin(), flags_.tangled.end(), 0);
    std::fill(flags_.pierced.begin(), flags_.pierced.end(), 0);
    const auto mark = [this](std::vector<char>& flag, int face) {
        for (int v : faces_[face]) flag[v] = 1;
    };
    tangle_count_ = 0;
    for (const auto& [a, b] : self_intersections(x, faces_)) {
        mark(flags_.tangled, a);
        mark(flags_.tangled, b);
        ++tangle_count_;
    }
    if (targets_version_ != body_corners.version) renew_targets(body_corners);
    for (const std::unique_ptr<IntersectionTarget>& target : targets_)
        for (const auto& [a, b] : target->intersections(x, faces_)) {
            mark(flags_.tangled, a);
            mark(flags_.pierced, a);
            ++tangle_count_;
        }
}

void Tangles::renew_targets(const TreeBodies& body_corners)
{
    targets_.clear();
    std::size_t first = 0;
    for (const Body& body : bodies_) {
        TriangleMesh mesh = body.mesh;
        std::copy_n(body_corners.corners.begin() + std::ptrdiff_t(first), mesh.vertices.size(), mesh.vertices.begin());
        first += mesh.vertices.size();
        targets_.push_back(std::make_unique<IntersectionTarget>(std::move(mesh)));
    }
    targets_version_ = body_corners.version;
}

void Tangles::set_flags(CrossingFlags flags)
{
    flags_ = std::move(flags);
    inside_count_ = int(std::count(flags_.inside.begin(), flags_.inside.end(), 1));
    tangle_count_ = int(std::count(flags_.tangled.begin(), flags_.tangled.end(), 1));
}

}  // namespace selvage
