#include "host/solver/stepping/step_control.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/parallel/launch.hpp"
#include "host/solver/state/vector_tools.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

constexpr double stability_margin = 0.9;
constexpr double least_fraction = 1.0 / 1024;  // of the longest step: below it a run has diverged
constexpr double most_gain = 0.25;             // of the energy that has moved so far: more comes from nowhere

}  // namespace

UnstableStepError::UnstableStepError(double asked, double stable)
    : std::runtime_error(fmt::format("a step of {:.3g} s is above the stability limit of {:.3g} s", asked, stable)),
      limit(stable)
{
}

void StepControl::keep(Saved& saved)
{
    const State& state = phase_.state();
    saved.pos = state.pos;
    saved.vel = state.vel;
    saved.anchor = state.friction_anchor;
    saved.limit = state.friction_limit;
    saved.hinge_anchor = state.hinge_anchor;
    if (phase_.cloth_contact()) saved.pairs = phase_.cloth_contact()->memory();
    const auto arrays = integrator_.history();
    saved.history.resize(arrays.size());
    for (std::size_t k = 0; k < arrays.size(); ++k) saved.history[k] = *arrays[k];
}

void StepControl::restore(const Saved& saved)
{
    State& state = phase_.state();
    state.pos = saved.pos;
    state.vel = saved.vel;
    state.friction_anchor = saved.anchor;
    state.friction_limit = saved.limit;
    state.hinge_anchor = saved.hinge_anchor;
    if (phase_.cloth_contact()) phase_.cloth_contact()->memory() = saved.pairs;
    const auto arrays = integrator_.history();
    for (std::size_t k = 0; k < arrays.size(); ++k) *arrays[k] = saved.history[k];
    if (phase_.contact()) phase_.contact()->update(state);
    phase_.newton().list_pairs();  // what was listed on the way that is given up says nothing of this place
}

// The length of the next step when `left` seconds are to be covered; an explicit scheme divides them evenly.
// @param begins  at a state that has been accepted: only there a run may end because of the limit
double StepControl::next_step(double left, bool begins)
{
    if (!integrator_.info().is_explicit) return std::min(dt_, left);
    limit_ = integrator_.stable_step();
    if (begins && options_.unstable == UnstableStep::refuse && options_.longest > limit_)
        throw UnstableStepError(options_.longest, limit_);
    const double margin = options_.unstable == UnstableStep::refuse ? 1 : stability_margin;
    return left / std::ceil(left / std::min(dt_, margin * limit_) - 1e-9);
}

// Bodies and pins must have come where the step ends. Newton's moves are cleared one by one; schemes that place the
// cloth without it are looked at as a whole.
bool StepControl::cloth_is_clear()
{
    ClothContact* cloth = phase_.cloth_contact();
    if (!cloth) return true;
    if (cloth->held_up()) return false;
    return !integrator_.may_gain_energy() || cloth->is_clear_from(phase_.state(), start_.pos);
}

bool StepControl::attempt(double dt, const NewtonOptions& options, bool accurate)
{
    report_ = integrator_.step(dt, options);
    if (!std::isfinite(report_.residual) || !is_finite(phase_.state())) return false;
    if (phase_.apply_rules(dt)) integrator_.displaced();
    if (!cloth_is_clear()) return false;
    if (report_.stuck && report_.iterations == 0 && report_.residual > 10 * options.tolerance) return false;
    return !accurate || report_.converged || report_.nearly;
}

// Fits the next step to the estimated error of the one just taken, which goes with a known power of its length.
bool StepControl::too_inaccurate(double dt)
{
    const double error = std::max(integrator_.error_estimate(), 1e-300);
    const double fit = 0.9 * std::pow(options_.error / error, 1.0 / integrator_.info().error_power);
    if (error > options_.error && dt > 2 * floor_) {
        dt_ = dt * std::clamp(fit, 0.2, 0.9);
        return true;
    }
    const double next = dt * std::clamp(fit, 0.2, 2.0);
    // A step that was cut short for another reason says nothing against longer ones.
    dt_ = std::min(options_.longest, dt < 0.999 * dt_ ? std::max(dt_, next) : next);
    return false;
}

// No vertex may have passed into a body. Ways are looked at in pieces short enough to be straight: the chord of a
// vertex that slides around a body for many short steps passes through it.
bool StepControl::passed_into_body(bool last)
{
    // Ways against moving bodies are cleared as they are gone.
    if (!phase_.contact() || (moves_ && phase_.cloth_contact())) return false;
    const State& state = phase_.state();
    const double piece = 0.5 * phase_.contact()->search_radius();
    if (!last && largest_distance(state, state.pos, looked_from_) < piece) return false;
    const bool passed = phase_.contact()->crossed(state, looked_from_);
    looked_from_ = state.pos;
    return passed;
}

// Nothing feeds the cloth but bodies and pins that move, whose work is not known: without them its energy falls, but
// for the waves of a scheme that keeps it on average.
bool StepControl::keeps_energy(double span, double kinetic_before, double potential_before)
{
    if (moves_ || !integrator_.may_gain_energy()) return true;
    if (std::isnan(first_energy_)) {
        first_energy_ = kinetic_before + potential_before;
        lowest_potential_ = potential_before;
    }
    highest_kinetic_ = std::max(highest_kinetic_, kinetic_before);
    lowest_potential_ = std::min(lowest_potential_, potential_before);
    const State& s = phase_.state();
    const double mass = sum_items(s.size.vertex_count, [&s](int v) { return s.inv_mass[v] == 0 ? 0.0 : s.mass[v]; });
    const double falling = 0.5 * mass * std::pow(9.81 * span, 2);
    const double moved = std::max(highest_kinetic_, first_energy_ - lowest_potential_) + falling;
    // What has just gone deep into a contact shows there only, and not in the planes that the step began with.
    if (phase_.contact()) phase_.contact()->update(phase_.state());
    const ActiveTerms& terms = phase_.newton().terms();
    return terms.kinetic_energy() + terms.potential_energy() - first_energy_ <= most_gain * moved;
}

// Back to where the step began.
void StepControl::give_up()
{
    if (moves_) phase_.place(clock_);
    restore(start_);
    looked_from_ = start_.pos;
}

// After a failure.
void StepControl::shrink(double dt)
{
    ++retries_;
    dt_ = 0.5 * dt;
    if (!(dt_ >= floor_))
        throw DivergenceError(
            fmt::format("no step down to {:.3g} s succeeds (solver.step is {:.3g} s); residual {:.3g}", dt_,
                        options_.longest, report_.residual));
}

double StepControl::advance(double room, const NewtonOptions& options, bool accurate)
{
    const bool fills = integrator_.info().is_explicit;
    const bool adaptive = options_.adaptive && integrator_.info().has_error_estimate();
    const ActiveTerms& terms = phase_.newton().terms();
    keep(start_);
    looked_from_ = start_.pos;
    floor_ = least_fraction * std::min(options_.longest, integrator_.stable_step());
    if (moves_) room = phase_.longest_step(clock_, room);
    const bool gains = integrator_.may_gain_energy();
    const double kinetic = gains ? terms.kinetic_energy() : 0, potential = gains ? terms.potential_energy() : 0;
    const double span = fills ? std::min(options_.longest, room) : room;
    double done = 0, first = 0;
    shortest_ = span;
    for (;;) {
        const double dt = next_step(span - done, done == 0);
        if (done == 0) first = dt;
        if (adaptive && done > 0) keep(last_);
        // A limit that collapses on the way, or is no number, is that of a state that bursts.
        const bool sound = !fills || dt >= floor_ || dt >= 0.5 * (span - done);
        const bool last = !fills || span - done - dt <= 1e-9 * span;
        if (moves_) phase_.move_to(clock_ + done + dt);
        const bool done_well = sound && attempt(dt, options, accurate);
        if (sound && report_.broken_off) {
            give_up();
            return taken_ = 0;
        }
        if (!done_well || passed_into_body(last) || (last && !keeps_energy(span, kinetic, potential))) {
            give_up();
            done = 0;
            shrink(first);
            continue;
        }
        if (adaptive && too_inaccurate(dt)) {
            ++retries_;
            if (moves_) phase_.place(clock_ + done);
            restore(done > 0 ? last_ : start_);
            looked_from_ = phase_.state().pos;
            continue;
        }
        if (!adaptive && last) dt_ = std::min(options_.longest, 1.5 * dt_);
        done += dt;
        shortest_ = std::min(shortest_, dt);
        if (!last) continue;
        taken_ = fills ? span : dt;
        clock_ += taken_;
        return taken_;
    }
}

}  // namespace selvage
