#include "host/solver/stepping/newton.hpp"

#include <algorithm>
#include <cmath>

#include "host/parallel/launch.hpp"
#include "host/solver/contact/anchors.hpp"
#include "kernels/stages/limit_step.h"

namespace selvage {
namespace {

constexpr double nearly_done = 10;         // times what would be done: a direction that gains no more may fail
constexpr double noise_of_promise = 1e-9;  // of the objective: what a direction may promise wrongly
constexpr double linear_tolerance_of_following = 0.1;
constexpr int iterations_of_following =
    60;                            // it only leads the cloth on: in a jam, which solves badly, part of it must do
constexpr int turns_of_cloth = 3;  // iterations for each move of bodies or pins: pushed on and on it cannot make way
constexpr int most_held_up = 60 * turns_of_cloth;  // iterations while they wait for it

// Sum over vertices of the product of two fields with three components.
double dot3(const State& state, const std::vector<real>& a, const std::vector<real>& b)
{
    const int vs = state.size.vertex_stride;
    return sum_items(state.size.vertex_count, [vs, x = a.data(), y = b.data()](int v) {
        return x[v] * y[v] + x[vs + v] * y[vs + v] + x[2 * vs + v] * y[2 * vs + v];
    });
}

}  // namespace

Newton::Newton(State& state, const Params& params, LinearSolver& linear, ContactField* contact, ClothContact* cloth,
               Profile& profile)
    : state_(state), params_(params), linear_(linear), contact_(contact), cloth_(cloth), profile_(profile),
      terms_(state, params, profile)
{
    for (std::vector<real>* v : {&start_, &origin_, &target_, &base_, &downhill_, &direction_})
        v->assign(state.pos.size(), 0);
    const double gravity =
        std::hypot(params.gravity.acceleration_x, params.gravity.acceleration_y, params.gravity.acceleration_z);
    // Without gravity forces are measured against the weight that the cloth would have on earth.
    const double scale = gravity > 0 ? gravity : 9.81;
    force_scale_ = std::sqrt(sum_items(state.size.vertex_count, [&state, scale](int v) {
        return state.inv_mass[v] == 0 ? 0.0 : scale * scale * state.mass[v] * state.mass[v];
    }));
}

double Newton::objective()
{
    double total = terms_.energy();
    if (inertia_ == 0) return total;
    total += span_ * terms_.dissipation();
    const int vs = state_.size.vertex_stride;
    return total + 0.5 * inertia_ * sum_items(state_.size.vertex_count, [this, vs](int v) {
                       double squared = 0;
                       for (int c = 0; c < 3; ++c) {
                           const double d = state_.pos[c * vs + v] - target_[c * vs + v];
                           squared += d * d;
                       }
                       return state_.inv_mass[v] == 0 ? 0.0 : state_.mass[v] * squared;
                   });
}

// downhill = f - m (x - target) / h^2, zero at vertices that are pinned or asleep.
void Newton::evaluate_gradient()
{
    terms_.evaluate_forces(inertia_ > 0);
    const int vs = state_.size.vertex_stride;
    if (!state_.awake.all) for_each_item(int(downhill_.size()), [to = downhill_.data()](int i) { to[i] = 0; });
    for_each_item(items_of(state_, ItemKind::vertex), [this, vs](int v) {
        for (int c = 0; c < 3; ++c) {
            const int i = c * vs + v;
            const double pull = inertia_ * state_.mass[v] * (target_[i] - state_.pos[i]);
            downhill_[i] = state_.inv_mass[v] == 0 ? 0 : state_.force[i] + pull;
        }
    });
}

double Newton::gradient_norm() const { return std::sqrt(dot3(state_, downhill_, downhill_)); }

void Newton::assemble(bool projected)
{
    // d2/dx2 of h R(v) is 1/h of d2R/dv2.
    terms_.evaluate_stiffness(projected, inertia_ > 0 ? 1 / span_ : 0);
    profile_.timed("assemble", state_.size.vertex_count, 0, [&] { linear_.assemble(state_, inertia_); });
    assembled_ = true;
}

// Solves for the direction; returns the slope of the objective along it (negative).
double Newton::search_direction(const NewtonOptions& options, NewtonReport& report)
{
    assemble(!options.full_stiffness);
    const LinearResult result = profile_.timed("linear_solve", state_.size.vertex_count, 0, [&] {
        return linear_.solve(downhill_.data(), options.linear_tolerance, direction_.data());
    });
    report.linear_iterations += result.iterations;
    report.negative += result.negative_curvature;
    report.blind += result.negative_curvature && result.iterations == 0;
    if (dot3(state_, downhill_, direction_) < 0)  // only an indefinite matrix can give this
        for_each_item(int(direction_.size()), [d = direction_.data()](int i) { d[i] = -d[i]; });
    promised_ = dot3(state_, downhill_, direction_);
    wanted_move_ = largest_move();
    if (!contact_ && !cloth_) return -promised_;
    free_direction_ = direction_;
    if (contact_) keep_outside_bodies();
    if (dot3(state_, downhill_, direction_) <= 0) take_free_direction();
    if (cloth_) {
        scale_to_longest(options);
        clear_way(false);
        if (dot3(state_, downhill_, direction_) <= 0) {
            take_free_direction();
            scale_to_longest(options);
            clear_way(true);
        }
    }
    return -dot3(state_, downhill_, direction_);
}

// Whoever has cleared a way has listed what is in contact on it: only who comes from elsewhere must look.
void Newton::list_pairs()
{
    if (cloth_) profile_.timed("cloth_contact_pairs", state_.size.vertex_count, 0, [&] { cloth_->update(state_); });
}

void Newton::clear_way(bool uniform)
{
    profile_.timed("cloth_contact_way", state_.size.vertex_count, 0,
                   [&] { cloth_->clear_way(state_, direction_, uniform); });
}

void Newton::scale_to_longest(const NewtonOptions& options)
{
    const double fraction = longest_fraction(options);
    if (fraction < 1) scale_direction(fraction);
}

void Newton::scale_direction(double by)
{
    for_each_item(int(direction_.size()), [d = direction_.data(), by](int i) { d[i] *= by; });
}

// Moves to base + fraction * direction.
void Newton::place(double fraction)
{
    const double inverse_span = inertia_ > 0 ? 1 / span_ : 0;
    const int vs = state_.size.vertex_stride;
    for_each_item(state_.size.vertex_count, [=, this](int v) {
        if (state_.inv_mass[v] == 0) return;
        for (int i = v; i < 3 * vs; i += vs) {
            state_.pos[i] = base_[i] + fraction * direction_[i];
            state_.vel[i] = inverse_span * (state_.pos[i] - origin_[i]);
        }
    });
}

void Newton::keep_outside_bodies()
{
    launch<limit_step_vertex>(state_.size.vertex_count, limit_step_args{state_.pos.data(), state_.contact_normal.data(),
                                                                        state_.contact_offset.data(), direction_.data(),
                                                                        state_.size.vertex_stride});
}

// The direction as it was found, short enough as a whole that no vertex passes its plane: cutting vertices one by one
// has turned it uphill.
void Newton::take_free_direction()
{
    direction_ = free_direction_;
    if (!contact_) return;
    const int vs = state_.size.vertex_stride;
    const double excess = max_items(state_.size.vertex_count, [this, vs](int v) {
        double gap = -state_.contact_offset[v], approach = 0;
        for (int i = v; i < 3 * vs; i += vs) {
            gap += state_.contact_normal[i] * state_.pos[i];
            approach -= state_.contact_normal[i] * direction_[i];
        }
        return gap > 0 ? approach / (gap * LIMIT_STEP_PART) : 0;
    });
    if (excess > 1) scale_direction(1 / excess);
}

// Starts a step from where it was, from where the cloth would fly on its own, or from what its motion so far lets
// expect: whichever has the lowest objective.
void Newton::guess_step(const NewtonOptions& options, const std::vector<real>* expected)
{
    if (contact_) contact_->update(state_);
    base_ = start_;
    const std::vector<real>* best = &start_;
    double lowest = objective();
    const auto go_to = [&](const std::vector<real>& to) {
        place(0);
        for_each_item(int(start_.size()), [&to, this, vs = state_.size.vertex_stride](int i) {
            direction_[i] = state_.inv_mass[i % vs] == 0 ? 0 : to[i] - start_[i];
        });
        if (contact_) keep_outside_bodies();
        if (cloth_) {
            scale_to_longest(options);
            clear_way(false);
        }
        place(longest_fraction(options));
    };
    const std::vector<real>* at = nullptr;
    for (const std::vector<real>* candidate : {expected, static_cast<const std::vector<real>*>(&target_)}) {
        if (!candidate) continue;
        // Ways through cloth are dear to clear: where there is any, one must do.
        if (at && cloth_ && cloth_->is_near_itself()) break;
        go_to(*candidate);
        at = candidate;
        const double there = objective();
        if (!(there < lowest)) continue;
        lowest = there;
        best = candidate;
    }
    if (best == &start_) place(0);
    if (best != &start_ && best != at) go_to(*best);
}

double Newton::largest_move() const
{
    const int vs = state_.size.vertex_stride;
    return std::sqrt(max_items(state_.size.vertex_count, [this, vs](int v) {
        const double x = direction_[v], y = direction_[vs + v], z = direction_[2 * vs + v];
        return x * x + y * y + z * z;
    }));
}

// The largest part of the direction that carries no vertex further than what is known of the bodies around it.
double Newton::longest_fraction(const NewtonOptions& options) const
{
    if (!contact_) return 1;
    const int vs = state_.size.vertex_stride;
    const double excess = max_items(state_.size.vertex_count, [this, vs, &options](int v) {
        double squared_way = 0, squared_normal = 0;
        for (int c = 0; c < 3; ++c) {
            squared_way += direction_[c * vs + v] * direction_[c * vs + v];
            squared_normal += state_.contact_normal[c * vs + v] * state_.contact_normal[c * vs + v];
        }
        return std::sqrt(squared_way) / (squared_normal > 0 ? options.max_move : options.max_far_move);
    });
    return excess > 1 ? 1 / excess : 1;
}

// Backtracks until the objective falls by a fraction of what the slope promises. Below the rounding noise of the
// objective the slope itself decides: a direction that still points downhill has not gone too far.
bool Newton::search_line(double slope, const NewtonOptions& options)
{
    base_ = state_.pos;
    const double before = objective();
    double fraction = longest_fraction(options);
    const double noise = 1e-13 * std::abs(before) + 1e-16;
    for (int attempt = 0; attempt < 16; ++attempt) {
        place(fraction);
        const double after = objective();
        if (std::isfinite(after) && after <= before + 1e-4 * fraction * slope) return true;
        if (std::isfinite(after) && std::abs(after - before) <= noise) {
            evaluate_gradient();
            if (std::abs(dot3(state_, downhill_, direction_)) <= 0.9 * std::abs(slope)) return true;
        }
        fraction *= 0.5;
    }
    place(0);
    return false;
}

// The first-order answer of the free vertices to moves of pinned ones: K_ff d = -K_fp u.
void Newton::follow_pins(std::vector<real>& move)
{
    if (!assembled_) assemble(true);
    linear_.multiply(move.data(), downhill_.data());
    for_each_item(int(move.size()), [this, vs = state_.size.vertex_stride](int i) {
        downhill_[i] = i % vs < state_.size.vertex_count && state_.inv_mass[i % vs] != 0 ? -downhill_[i] : 0;
    });
    linear_.solve(downhill_.data(), linear_tolerance_of_following, direction_.data(), iterations_of_following);
    if (contact_) keep_outside_bodies();
    for_each_item(int(move.size()), [&, this, vs = state_.size.vertex_stride](int i) {
        if (state_.inv_mass[i % vs] != 0) move[i] = direction_[i];
    });
}

// Moves bodies and pins on, with what they push. Returns whether they are not where they are to be yet.
bool Newton::advance_held()
{
    if (!cloth_ || !cloth_->held_up()) return false;
    const bool held_up = profile_.timed("advance_held", state_.size.vertex_count, 0, [&] {
        return cloth_->advance_held(state_, [this](std::vector<real>& move) { follow_pins(move); });
    });
    base_ = state_.pos;
    place(0);
    return held_up;
}

NewtonReport Newton::iterate(const NewtonOptions& options, bool settle_each)
{
    NewtonReport report;
    for (;; ++report.iterations) {
        report.broken_off = options.stop && *options.stop && (*options.stop)();
        if (report.broken_off) return report;
        const bool held_up = report.iterations % turns_of_cloth == 0 ? advance_held() : cloth_ && cloth_->held_up();
        if (contact_) profile_.timed("body_query", state_.size.vertex_count, 0, [&] { contact_->update(state_); });
        if (settle_each) settle();
        evaluate_gradient();
        report.residual = gradient_norm() / force_scale_;
        report.converged = !held_up && report.residual <= options.tolerance;
        const int most = held_up ? std::max(options.max_iterations, most_held_up) : options.max_iterations;
        if (report.converged || report.iterations >= most) return report;
        const double slope = search_direction(options, report);
        // Stiff directions leave forces that no longer move anything: what counts in a motion is the way, not the
        // force. A way that has been cut short says nothing: what it would have been does.
        report.converged =
            !held_up &&
            (wanted_move_ <= options.still * span_ ||
             (promised_ <= options.decrement * terms_.kinetic_energy() && wanted_move_ <= options.most_left));
        report.stuck = !std::isfinite(slope) || !search_line(slope, options);
        report.nearly = report.stuck && promised_ <= nearly_done * options.decrement * terms_.kinetic_energy() +
                                                         noise_of_promise * std::abs(objective());
        if ((report.stuck && !held_up) || report.converged) return report;
    }
}

NewtonReport Newton::minimise(double span, const std::vector<real>& origin, const std::vector<real>& target,
                              const NewtonOptions& options, const std::vector<real>* expected)
{
    if (cloth_) cloth_->start_step();
    span_ = span;
    assembled_ = false;
    inertia_ = 1 / (span * span);
    start_ = state_.pos;
    origin_ = origin;
    target_ = target;
    for_each_item(int(state_.vel.size()),
                  [this, inverse = 1 / span](int i) { state_.vel[i] = inverse * (start_[i] - origin_[i]); });
    guess_step(options, expected);
    return iterate(options, false);
}

NewtonReport Newton::step(double dt, const NewtonOptions& options)
{
    base_ = state_.pos;
    for_each_item(int(base_.size()), [this, dt](int i) { direction_[i] = base_[i] + dt * state_.vel[i]; });
    const NewtonReport report = minimise(dt, base_, direction_, options);
    settle();
    return report;
}

void Newton::settle()
{
    settle_anchors(state_, params_);
    if (cloth_) cloth_->settle(state_, params_);
}

NewtonReport Newton::relax(const NewtonOptions& options)
{
    span_ = 0;
    assembled_ = false;
    inertia_ = 0;
    start_ = origin_ = state_.pos;
    std::fill(state_.vel.begin(), state_.vel.end(), 0);
    if (cloth_) cloth_->start_step();
    list_pairs();
    return iterate(options, true);
}

double Newton::static_residual()
{
    inertia_ = 0;
    list_pairs();
    evaluate_gradient();
    const double asleep = state_.awake.all ? 0 : state_.awake.force_squared;
    return std::sqrt(dot3(state_, downhill_, downhill_) + asleep) / force_scale_;
}

}  // namespace selvage
