#include "host/solver/stepping/system.hpp"

#include <algorithm>
#include <cmath>

#include "host/parallel/launch.hpp"
#include "host/solver/contact/anchors.hpp"
#include "host/solver/state/planes.hpp"
#include "host/solver/state/vectors.hpp"
#include "host/solver/terms/face_air.hpp"

namespace selvage {
namespace {

constexpr double gravity_on_earth = 9.81;  // [m/s^2]

double gravity_or_earths(const Params& params)
{
    const double gravity =
        std::hypot(params.gravity.acceleration_x, params.gravity.acceleration_y, params.gravity.acceleration_z);
    return gravity > 0 ? gravity : gravity_on_earth;
}

// The weight of the free vertices, as root of the sum of its squares. Where none is free there is no force either, and
// any weight will do.
double weight_of(const State& state, double scale)
{
    const double square = sum_items(state.size.vertex_count, [&state, scale](int v) {
        return state.inv_mass[v] == 0 ? 0.0 : scale * scale * state.mass[v] * state.mass[v];
    });
    return square > 0 ? std::sqrt(square) : 1;
}

void set_air(auto& term, const Vec3& velocity)
{
    term.velocity_x = velocity.x();
    term.velocity_y = velocity.y();
    term.velocity_z = velocity.z();
}

std::vector<const VelocityFilter*> active_velocity_filters(const Params& params)
{
    std::vector<const VelocityFilter*> filters;
    for (const VelocityFilter& filter : all_velocity_filters())
        if (filter.is_active(params)) filters.push_back(&filter);
    return filters;
}

}  // namespace

System::System(State state, const Params& params, Profile& profile, Surroundings surroundings)
    : state_(std::move(state)), params_(params), profile_(profile), around_(std::move(surroundings)),
      bodies_exert_forces_(around_.bodies && !(params.velocity_rule.gap > 0)), terms_(state_, params_, profile),
      velocity_filters_(active_velocity_filters(params)), gravity_scale_(gravity_or_earths(params)),
      force_scale_(weight_of(state_, gravity_scale_)), static_force_(state_.pos.size())
{
    refresh_air();
    if (!around_.cloth || !around_.bodies || around_.bodies->motion_end() == 0) return;
    around_.cloth->set_carry([this](State& moved, double part) {
        const double now = around_.bodies->time(), goal = clock_.end();
        around_.bodies->move_to(moved, part == 1 ? goal : now + part * (goal - now));
    });
}

const std::vector<real>& System::static_force() const
{
    terms_.conservative_force(static_force_);
    clear_resting(state_, static_force_);
    return static_force_;
}

double System::residual_of(const std::vector<real>& static_force) const
{
    const double asleep = state_.awake.all ? 0 : state_.awake.force_squared;
    return std::sqrt(dot(state_, static_force, static_force) + asleep) / force_scale_;
}

Energies System::energies() const
{
    using enum EnergyFamily;
    return {.gravity = energy_of(external),
            .membrane = energy_of(membrane),
            .bending = energy_of(bending),
            .seam = energy_of(seam),
            .contact = energy_of(contact) + energy_of(friction),
            .kinetic = kinetic_energy()};
}

void System::find_contacts()
{
    const TraceScope scope("look_around");
    refresh_planes();
    refresh_air();
    if (around_.cloth) around_.cloth->begin(state_);
}

void System::hold_by_friction()
{
    if (!around_.bodies) return;
    refresh_pairs();
    settle_friction(state_, params_);
    evaluate_forces(false);
    selvage::hold_by_friction(state_, params_);
}

void System::refresh_planes()
{
    if (around_.bodies) around_.bodies->update(state_);
}

void System::refresh_air()
{
    if (state_.face_air.empty()) return;
    if (around_.air) {
        const Vec3 velocity = around_.air->velocity(clock_.end());
        set_air(params_.wind, velocity);
        set_air(params_.air_drag, velocity);
    }
    profile_.timed("face_air", state_.size.face_count, std::int64_t(face_air_bytes(state_)),
                   [&] { find_face_air(state_); });
}

// The searches within it have records of their own, whose items are the pairs that were measured.
template <class Work>
void System::timed_contact(std::string_view name, const Work& work)
{
    const TreeCounts before = around_.cloth->search_counts();
    profile_.timed(name, state_.size.vertex_count, 0, work);
    const TreeCounts& after = around_.cloth->search_counts();
    const auto add = [this](std::string_view search, const SearchCounts& from, const SearchCounts& to) {
        if (to.searches > from.searches)
            profile_.add({std::string(search), to.searches - from.searches, to.spent - from.spent,
                          to.measured - from.measured, 0});
    };
    add("cloth_search", before.whole, after.whole);
    add("cloth_search_part", before.partial, after.partial);
}

void System::refresh_pairs()
{
    if (!around_.cloth) return;
    timed_contact("cloth_contact_pairs", [&] { around_.cloth->update(state_); });
}

void System::forget_searches()
{
    if (around_.cloth) around_.cloth->forget_searches();
}

void System::limit_by_pairs(std::vector<real>& move, bool uniform)
{
    if (!around_.cloth) return;
    timed_contact("cloth_contact_way", [&] { around_.cloth->filter_step(state_, move, uniform); });
}

void System::settle()
{
    settle_anchors(state_, params_);
    refresh_air();
    if (around_.cloth) around_.cloth->settle(state_, params_);
}

bool System::apply_velocity_filters(double dt)
{
    if (velocity_filters_.empty()) return false;
    if (around_.bodies) profile_.timed("body_query", state_.size.vertex_count, 0, [&] { refresh_planes(); });
    for (const VelocityFilter* filter : velocity_filters_) {
        const int count = filter->item_count(state_.size);
        profile_.timed(filter->name, count, std::int64_t(count) * filter->bytes_per_item,
                       [&] { filter->apply(state_, params_, dt); });
    }
    return around_.bodies && around_.bodies->contact_count() > 0;
}

double System::motion_end() const
{
    const double pinned = around_.pins ? around_.pins->end() : 0;
    return std::max(pinned, around_.bodies ? around_.bodies->motion_end() : 0.0);
}

double System::longest_step(double room) const
{
    const double way = 0.5 * (body_gap(params_) + around_.contact_margin);
    const double pinned = around_.pins ? around_.pins->longest_step(clock_.time, room, way) : room;
    if (!around_.bodies || around_.bodies->motion_end() <= clock_.time) return pinned;
    const ConstPlanes x = vertex_planes(state_.size, state_.pos), v = vertex_planes(state_.size, state_.vel);
    Box reach;  // of the cloth, if it goes on as it does
    for (int k = 0; k < x.count; ++k) {
        reach.extend(x(k));
        reach.extend(x(k) + pinned * v(k));
    }
    return around_.bodies->longest_step(clock_.time, pinned, reach);
}

void System::place_boundary()
{
    if (around_.bodies) around_.bodies->place(state_, clock_.time);
    if (around_.cloth) around_.cloth->place_bodies(state_, clock_.time);
}

void System::move_boundary()
{
    const double end = clock_.end();
    if (around_.cloth) {
        around_.cloth->set_boundary_targets(
            around_.pins ? around_.pins->places(end) : std::vector<MovingBoundary::PinTarget>{}, end);
        return;
    }
    if (around_.bodies) around_.bodies->move_to(state_, end);
    if (around_.pins) around_.pins->move_to(state_, end);
}

bool System::advance_boundary(const MovingBoundary::Follow& follow)
{
    if (!boundary_waits()) return false;
    timed_contact("advance_held", [&] { around_.cloth->advance_boundary(state_, follow); });
    return boundary_waits();
}

}  // namespace selvage
