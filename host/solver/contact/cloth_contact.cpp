#include "host/solver/contact/cloth_contact.hpp"

#include <cmath>

#include "host/parallel/launch.hpp"
#include "host/solver/contact/cloth_body_contact.hpp"
#include "host/solver/contact/cloth_surface.hpp"
#include "host/solver/contact/contact_tuning.hpp"

namespace selvage {
namespace {

std::vector<Body> touchable(const std::vector<Body>& bodies, const Cloth& cloth)
{
    std::vector<Body> result;
    for (const Body& body : bodies)
        if (!clear_by_vertices(body, cloth)) result.push_back(body);
    return result;
}

TreeSurface whole_surface(const Topology& topology, const Cloth& cloth, const std::vector<Body>& bodies)
{
    TreeSurface surface = tree_surface(topology, cloth);
    add_bodies(surface, bodies);
    return surface;
}

// What moving bodies push goes along with them: it has to be known from where vertices are pressed on.
double body_reach(const ContactGaps& gaps, const MovingBoundary& boundary)
{
    return boundary.moves() ? gaps.largest() : gaps.largest_of_bodies();
}

std::vector<int> particle_pieces(const Topology& topology, const Cloth& cloth)
{
    const std::vector<int> piece = pieces_of(cloth);
    std::vector<int> result(std::size_t(topology.particle_count));
    for (std::size_t v = 0; v < piece.size(); ++v) result[topology.particle_of[v]] = piece[v];
    return result;
}

// A third of the rest area of every adjacent face.
std::vector<double> particle_areas(const Topology& topology, const Cloth& cloth)
{
    std::vector<double> area(std::size_t(topology.particle_count));
    for (std::size_t f = 0; f < cloth.faces.size(); ++f) {
        const Face& c = cloth.faces[f];
        const Vec2 a = cloth.panel_coordinates[c[1]] - cloth.panel_coordinates[c[0]];
        const Vec2 b = cloth.panel_coordinates[c[2]] - cloth.panel_coordinates[c[0]];
        for (int particle : topology.faces[f]) area[particle] += std::abs(a.x() * b.y() - a.y() * b.x()) / 6;
    }
    return area;
}

}  // namespace

ClothContact::ClothContact(const Topology& topology, const Cloth& cloth, const std::vector<Body>& bodies,
                           ContactGaps gaps, std::vector<double> friction, std::vector<double> hardness)
    : gaps_(std::move(gaps)), boundary_(touchable(bodies, cloth)),
      tangles_(topology.faces, topology.particle_count, boundary_.bodies()),
      filter_(whole_surface(topology, cloth, boundary_.bodies()), ContactTuning::tree_slack * typical_edge(cloth),
              gaps_, body_reach(gaps_, boundary_), tangles_.flags()),
      pairs_(gaps_, ContactShares(topology.faces, particle_pieces(topology, cloth)), particle_areas(topology, cloth),
             std::move(friction), std::move(hardness))
{
}

void ClothContact::begin(State& state)
{
    state.set_body_points(int(boundary_.corners().corners.size()));
    tangles_.find(state, boundary_.corners());
    boundary_.write_corners(state);
}

void ClothContact::update(State& state)
{
    filter_.refresh({state.pos, nullptr, state.size.vertex_stride, boundary_.corners()});
    list_pairs(state);
}

void ClothContact::filter_step(State& state, std::vector<real>& displacement, bool uniform)
{
    filter_.filter_step(state.pos, displacement, state.size.vertex_stride, boundary_.corners(), uniform);
    list_pairs(state);
}

bool ClothContact::is_clear_from(State& state, const std::vector<real>& from)
{
    std::vector<real> displacement(from.size());
    for_each_item(int(from.size()), [&](int i) { displacement[i] = state.pos[i] - from[i]; });
    const bool clear = filter_.is_free({from, &displacement, state.size.vertex_stride, boundary_.corners()});
    update(state);
    return clear;
}

bool ClothContact::advance_boundary(State& state, const MovingBoundary::Follow& follow)
{
    if (!boundary_.is_pending()) return false;
    boundary_.advance(state, filter_, follow);
    update(state);
    return boundary_.is_pending();
}

Vec3 ClothContact::nearest_point(const State& state, const PairCandidate& pair) const
{
    const PairCorners x =
        StraightStep{state.pos, nullptr, state.size.vertex_stride, boundary_.corners()}.start_of(pair);
    const pair_weights weights = closest_weights(x, pair.edges);
    Vec3 point = Vec3::Zero();
    for (int k = 0; k < (pair.edges ? 2 : 1); ++k) point += weights.w[k] * x[k];
    return point;
}

void ClothContact::settle(State& state, const Params& params)
{
    tangles_.update(state, boundary_.corners());
    pairs_.settle(state, params);
}

ClothContactCounts ClothContact::counts() const
{
    return {filter_.counts().refreshes, filter_.counts().shortened, tangles_.inside_count(), tangles_.tangle_count()};
}

}  // namespace selvage
