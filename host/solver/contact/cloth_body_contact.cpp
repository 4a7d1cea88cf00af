#include "host/solver/contact/cloth_body_contact.hpp"

#include <algorithm>
#include <cmath>

#include "host/model/body.hpp"
#include "host/model/cloth_model.hpp"
#include "host/parallel/launch.hpp"

namespace selvage {
namespace {

// By hand.
struct SagTuning {
    static constexpr double stretched = 1.1;   // edges may be so much longer than at rest [1]
    static constexpr double most_sag = 0.025;  // within the margin in which a vertex knows its surface [m]
};

}  // namespace

std::vector<double> particle_friction(const Topology& topology, const Cloth& cloth, const FabricTable& fabrics)
{
    std::vector<double> result(std::size_t(topology.particle_count), 0.0);
    for (const ClothPanel& panel : cloth.panels) {
        const double friction = fabrics.at(panel.fabric).friction;
        for (int v = panel.first_vertex; v < panel.first_vertex + panel.vertex_count; ++v) {
            double& of_particle = result[topology.particle_of[v]];
            of_particle = std::max(of_particle, friction);
        }
    }
    return result;
}

double chord_sag(const Body& body, const Cloth& cloth)
{
    if (body.kind != Body::Kind::sphere && body.kind != Body::Kind::capsule) return 0;
    double longest = 0;
    for (const Face& f : cloth.faces)
        for (int k = 0; k < 3; ++k)
            longest =
                std::max(longest, (cloth.panel_coordinates[f[k]] - cloth.panel_coordinates[f[(k + 1) % 3]]).norm());
    return std::pow(SagTuning::stretched * longest, 2) / (6 * body.radius);
}

bool clear_by_vertices(const Body& body, const Cloth& cloth)
{
    if (body.kind == Body::Kind::plane) return true;
    return body.kind != Body::Kind::mesh && !body.motion && chord_sag(body, cloth) <= SagTuning::most_sag;
}

ClothBodyContact::ClothBodyContact(BodyQuery& query, const std::vector<Body>& bodies, const Topology& topology,
                                   const Cloth& cloth, const FabricTable& fabrics, double gap, double margin,
                                   bool by_faces, ContactHardness hardness)
    : query_(query), fabric_friction_(particle_friction(topology, cloth, fabrics)), hardness_(std::move(hardness)),
      body_of_vertex_(std::size_t(topology.particle_count), -1), gap_(gap), margin_(margin)
{
    for (const Body& body : bodies) {
        body_friction_.push_back(body.friction);
        const bool by_vertices = !by_faces || clear_by_vertices(body, cloth);
        body_sag_.push_back(by_vertices ? std::min(chord_sag(body, cloth), SagTuning::most_sag) : 0);
    }
}

void ClothBodyContact::lift(const std::vector<char>& pierced, double by)
{
    pierced_ = &pierced;
    lift_ = std::min(by, 0.5 * margin_);
}

void ClothBodyContact::update(State& state)
{
    const int count = state.size.vertex_count, vs = state.size.vertex_stride;
    query_.nearest(state.pos.data(), vs, count, search_radius(),
                   {vs, state.contact_normal.data(), state.contact_offset.data(), body_of_vertex_.data()});
    for_each_item(count, [this, &state](int v) {
        if (body_of_vertex_[v] < 0) return;
        state.contact_offset[v] += body_sag_[body_of_vertex_[v]];
        if (pierced_ && (*pierced_)[v]) state.contact_offset[v] += lift_;
    });
    contact_count_ = int(sum_items(count, [&state, vs, gap = gap_](int v) {
        double along = -state.contact_offset[v];
        for (int c = 0; c < 3; ++c) along += state.contact_normal[c * vs + v] * state.pos[c * vs + v];
        return along < gap ? 1.0 : 0.0;
    }));
    if (!state.contact_hardness.empty() && !hardness_.of_particle.empty())
        for_each_item(count, [this, &state](int v) {
            const int body = body_of_vertex_[v];
            state.contact_hardness[v] = hardness_.of_particle[v] * (body >= 0 ? hardness_.of_body[body] : 1);
        });
    if (state.contact_friction.empty()) return;
    for_each_item(count, [this, &state](int v) {
        const int body = body_of_vertex_[v];
        const bool own = body >= 0 && !std::isnan(body_friction_[body]);
        state.contact_friction[v] = own ? body_friction_[body] : fabric_friction_[v];
    });
}

double ClothBodyContact::longest_step(double time, double room, const Box& cloth) const
{
    const Vec3 margin = Vec3::Constant(search_radius());
    return query_.longest_step(time, room, 0.5 * search_radius(), {cloth.min() - margin, cloth.max() + margin});
}

void ClothBodyContact::place(State& state, double time)
{
    query_.move_to(time);
    update(state);
}

void ClothBodyContact::move_to(State& state, double time)
{
    const bool moving = query_.time() < query_.motion_end();
    if (moving) update(state);  // a step may end beyond where it last looked
    query_.move_to(time);
    if (!moving || state.friction_limit.empty()) return;
    const int vs = state.size.vertex_stride;
    for_each_item(state.size.vertex_count, [&query = query_, &state, vs](int v) {
        if (!(state.friction_limit[v] > 0)) return;
        std::vector<real>& anchor = state.friction_anchor;
        const Vec3 carried = query.carried(v, {anchor[v], anchor[vs + v], anchor[2 * vs + v]});
        for (int c = 0; c < 3; ++c) anchor[c * vs + v] = carried[c];
    });
}

bool ClothBodyContact::crossed(const State& state, const std::vector<real>& from)
{
    const int vs = state.size.vertex_stride;
    const std::vector<BodyCrossing> crossings =
        query_.crossings(from.data(), state.pos.data(), vs, state.size.vertex_count);
    for (int v = 0; v < state.size.vertex_count; ++v)
        // The barrier drives a vertex out again that is just below the surface; a deeper one may come out elsewhere.
        if (crossings[v].body >= 0 && crossings[v].way_beyond > 2 * gap_) return true;
    return false;
}

}  // namespace selvage
