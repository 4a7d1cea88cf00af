#include "host/solver/contact/moving_boundary.hpp"

#include <algorithm>
#include <tuple>

#include "host/parallel/launch.hpp"
#include "host/solver/contact/contact_tuning.hpp"

namespace selvage {

MovingBoundary::MovingBoundary(std::vector<Body> bodies) : bodies_(std::move(bodies))
{
    for (const Body& body : bodies_)
        corners_.insert(corners_.end(), body.mesh.vertices.begin(), body.mesh.vertices.end());
    target_corners_ = corners_;
}

void MovingBoundary::set_targets(std::vector<PinTarget> pins, double time)
{
    pins_ = std::move(pins);
    std::size_t first = 0;
    for (const Body& body : bodies_) {
        if (body.motion) {
            const std::vector<Vec3> vertices = body_mesh_at(body, time).vertices;
            std::copy(vertices.begin(), vertices.end(), target_corners_.begin() + std::ptrdiff_t(first));
        }
        first += body.mesh.vertices.size();
    }
    pending_ = true;
}

void MovingBoundary::place_bodies(State& state, double time)
{
    set_targets({}, time);
    pending_ = false;
    corners_ = target_corners_;
    ++version_;
    write_corners(state);
}

void MovingBoundary::write_corners(State& state) const
{
    if (state.body_point.empty()) return;
    for (std::size_t k = 0; k < corners_.size(); ++k)
        for (int c = 0; c < 3; ++c)
            state.body_point[c * std::size_t(state.size.body_point_stride) + k] = corners_[k][c];
}

// Empty if no body moves.
std::vector<Vec3> MovingBoundary::body_displacements() const
{
    std::vector<Vec3> displacements(corners_.size());
    for (std::size_t k = 0; k < displacements.size(); ++k) displacements[k] = target_corners_[k] - corners_[k];
    if (std::all_of(displacements.begin(), displacements.end(), [](const Vec3& u) { return u.isZero(0); }))
        displacements.clear();
    return displacements;
}

// Returns whether any pin moves.
bool MovingBoundary::displace_pins(const State& state, std::vector<real>& displacement) const
{
    const int vs = state.size.vertex_stride;
    bool any = false;
    for (const auto& [particle, target] : pins_)
        for (int c = 0; c < 3; ++c) {
            real& u = displacement[c * vs + particle];
            u = target[c] - state.pos[c * vs + particle];
            any = any || u != 0;
        }
    return any;
}

// Vertices go along with the nearest point of a body that comes towards them or holds them by friction.
// @param filter  whose distances are those of the start
void MovingBoundary::carry_along(const State& state, const CcdFilter& filter, const StraightStep& step,
                                 std::vector<real>& displacement) const
{
    const std::vector<PairCandidate>& candidates = filter.candidates();
    const std::vector<PairDistance>& distances = filter.distances();
    std::vector<int> nearest(std::size_t(state.size.vertex_count), -1);
    const auto is_nearer = [&](std::size_t a, int b) {  // whatever their order in the list
        return std::tie(distances[a].distance, candidates[a].edges, candidates[a].corner) <
               std::tie(distances[b].distance, candidates[b].edges, candidates[b].corner);
    };
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const auto& c = candidates[k].corner;
        if (!distances[k].relevant || std::max(c[0], c[3]) < 0 || !has_body(candidates[k])) continue;
        if (distances[k].distance > filter.gaps().of_cloth(candidates[k])) continue;
        for (int v : c)
            if (v >= 0 && (nearest[v] < 0 || is_nearer(k, nearest[v]))) nearest[v] = int(k);
    }
    for_each_item(state.size.vertex_count, [&](int v) {
        if (nearest[v] < 0 || state.inv_mass[v] == 0) return;
        const PairCandidate& candidate = candidates[nearest[v]];
        const PairCorners x = step.start_of(candidate);
        const pair_weights p = closest_weights(x, candidate.edges);
        Vec3 from_body = Vec3::Zero(), shift = Vec3::Zero();
        double sum = 0;
        for (int i = 0; i < 4; ++i) {
            from_body += p.w[i] * x[i];
            if (candidate.corner[i] >= 0) continue;
            sum += p.w[i];
            shift += p.w[i] * step.displacement_of(candidate.corner[i]);
        }
        shift /= sum;
        if (candidate.corner[0] < 0) from_body = -from_body;
        const bool held = !state.friction_limit.empty() && state.friction_limit[v] > 0;
        if (!held && shift.dot(from_body) <= 0) return;
        for (int c = 0; c < 3; ++c) displacement[c * step.stride + v] = shift[c];
    });
}

// Cloth that only follows pins need not come as far as they do: vertices that would hit something are shortened one by
// one, so that a jam in one place does not stop pins in another. What pins themselves would hit is left to the caller.
void MovingBoundary::limit_followers(const State& state, CcdFilter& filter, const StraightStep& step,
                                     std::vector<real>& displacement) const
{
    const auto is_pin = [&](int corner) { return corner >= 0 && state.inv_mass[corner] == 0; };
    for (int round = 0; round < ContactTuning::local_rounds; ++round) {
        std::vector<float> fractions = filter.free_fractions(step, filter.held_margins());
        const std::vector<PairCandidate>& candidates = filter.candidates();
        for_each_item(int(fractions.size()), [&](int k) {
            const auto& c = candidates[k].corner;
            if (fractions[k] < 1 && std::any_of(c.begin(), c.end(), is_pin)) fractions[k] = 1;
        });
        if (!filter.limit_vertices(displacement, step.stride, fractions)) return;
        filter.refresh(step);
    }
}

// Returns which fraction of the step is free, after shortening followers where that helps pins.
float MovingBoundary::filter_advance(const State& state, CcdFilter& filter, const StraightStep& step,
                                     std::vector<real>& displacement) const
{
    filter.refresh(step);
    const float fraction = filter.free_fraction(step, filter.held_margins());
    // What a body presses on has to go ahead of it, or it is run through.
    if (fraction >= ContactTuning::jammed || step.bodies.moves) return fraction;
    limit_followers(state, filter, step, displacement);
    return std::min(filter.free_fraction(step, filter.held_margins()), ContactTuning::most_ahead);
}

void MovingBoundary::advance(State& state, CcdFilter& filter, const Follow& follow)
{
    const int vs = state.size.vertex_stride;
    std::vector<real> displacement(state.pos.size());
    const std::vector<Vec3> body_displacement = body_displacements();
    const bool bodies_move = !body_displacement.empty();
    const StraightStep step{
        state.pos, &displacement, vs, {corners_, bodies_move ? &body_displacement : nullptr, version_}};
    if (displace_pins(state, displacement)) follow(displacement);
    if (bodies_move) {
        filter.refresh({state.pos, nullptr, vs, corners()});
        carry_along(state, filter, step, displacement);
    }
    take(state, filter_advance(state, filter, step, displacement), displacement, body_displacement);
}

std::optional<PairCandidate> MovingBoundary::obstacle(const State& state, CcdFilter& filter) const
{
    const int vs = state.size.vertex_stride;
    std::vector<real> displacement(state.pos.size());
    const std::vector<Vec3> body_displacement = body_displacements();
    const StraightStep step{
        state.pos, &displacement, vs, {corners_, body_displacement.empty() ? nullptr : &body_displacement, version_}};
    displace_pins(state, displacement);
    if (!body_displacement.empty()) {
        filter.refresh({state.pos, nullptr, vs, corners()});
        carry_along(state, filter, step, displacement);
    }
    filter.refresh(step);
    const std::vector<float> fractions = filter.free_fractions(step, filter.held_margins());
    const auto least = std::min_element(fractions.begin(), fractions.end());
    if (least == fractions.end() || *least == 1) return {};
    return filter.candidates()[std::size_t(least - fractions.begin())];
}

const Body& MovingBoundary::body_of_corner(int corner) const
{
    std::size_t left = std::size_t(-1 - corner);
    auto body = bodies_.begin();
    for (; left >= body->mesh.vertices.size(); ++body) left -= body->mesh.vertices.size();
    return *body;
}

// Bodies and pins that get all the way are exactly where they are to be, whatever rounding gives.
void MovingBoundary::take(State& state, float fraction, const std::vector<real>& displacement,
                          const std::vector<Vec3>& body_displacement)
{
    const int vs = state.size.vertex_stride;
    const bool whole = fraction == 1;
    if (carry_) carry_(state, fraction);
    for_each_item(int(displacement.size()), [&](int i) { state.pos[i] += fraction * displacement[i]; });
    if (whole)
        for (const auto& [particle, target] : pins_)
            for (int c = 0; c < 3; ++c) state.pos[c * vs + particle] = target[c];
    for (std::size_t k = 0; k < body_displacement.size(); ++k)
        corners_[k] = whole ? target_corners_[k] : Vec3(corners_[k] + fraction * body_displacement[k]);
    pending_ = !whole;
    version_ += !body_displacement.empty();
    write_corners(state);
}

}  // namespace selvage
