#include "host/solver/stepping/step_control.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/solver/state/planes.hpp"
#include "host/solver/state/vectors.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

constexpr double stability_margin = 0.9;
constexpr double most_gain = 0.25;  // of the energy that has moved so far: more comes from nowhere

}  // namespace

UnstableStepError::UnstableStepError(double asked, double stable)
    : std::runtime_error(fmt::format("a step of {:.3g} s is above the stability limit of {:.3g} s", asked, stable)),
      limit(stable)
{
}

StepControl::StepControl(Phase& phase, Integrator& integrator, const StepOptions& options, const StepMemory& memory)
    : system_(phase.system()), integrator_(integrator), options_(options), memory_(memory),
      moves_(options.moves_boundary && system_.motion_end() > 0)
{
    if (memory.dt > 0) return;
    memory_.dt = options.longest;
    if (moves_) system_.place_boundary();
}

void StepControl::return_to(const SolverSnapshot& place, double time)
{
    system_.clock() = {time, 0};
    if (moves_) system_.place_boundary();
    restore(system_, &integrator_, place);
    system_.refresh_air();
    system_.refresh_planes();
    system_.refresh_pairs();  // what was listed on the way that is given up says nothing of this place
    looked_from_ = place.fields.pos;
}

// The length of the next step when `left` seconds are to be covered; an explicit scheme divides them evenly.
// @param begins  at a state that has been accepted: only there a run may end because of the limit
// @param even    steps of about one length are to cover it: a short one after a long one upsets schemes that look back
double StepControl::next_step(double left, bool begins, bool even)
{
    if (!fills()) return even ? left / std::ceil(left / std::min(memory_.dt, left) - 1e-9) : std::min(memory_.dt, left);
    limit_ = integrator_.stable_step();
    if (begins && options_.unstable == UnstableStep::refuse && options_.longest > limit_)
        throw UnstableStepError(options_.longest, limit_);
    const double margin = options_.unstable == UnstableStep::refuse ? 1 : stability_margin;
    return left / std::ceil(left / std::min(memory_.dt, margin * limit_) - 1e-9);
}

// Bodies and pins must have come where the step ends. Newton's moves are cleared one by one; schemes that place the
// cloth without it are looked at as a whole.
bool StepControl::cloth_is_clear()
{
    ClothContact* cloth = system_.cloth_contact();
    if (!cloth) return true;
    if (cloth->boundary_is_pending()) return false;
    return !integrator_.may_gain_energy() || cloth->is_clear_from(system_.state(), start_.fields.pos);
}

bool StepControl::solve(double dt, const NewtonOptions& options, bool accurate)
{
    report_ = integrator_.step(dt, options);
    if (!std::isfinite(report_.residual) || !is_finite(system_.state())) return fail(StepFault::not_finite);
    if (system_.apply_velocity_filters(dt)) integrator_.displaced();
    if (!cloth_is_clear()) return fail(system_.boundary_waits() ? StepFault::blocked : StepFault::passed);
    if (report_.stuck && report_.iterations == 0 && report_.residual > 10 * options.tolerance)
        return fail(StepFault::stuck);
    if (!accurate || report_.converged || report_.almost_converged) return true;
    return fail(report_.stuck ? StepFault::stuck : StepFault::unsolved);
}

// Notes why an attempt fails. @returns false
bool StepControl::fail(StepFault fault)
{
    failure_ = {.fault = fault};
    return false;
}

// What can be told of an attempt that is the last, while the state is still where it led to.
void StepControl::note_failure(double dt)
{
    const State& state = system_.state();
    const int n = state.size.vertex_count;
    failure_.step = dt;
    failure_.longest = options_.longest;
    failure_.residual = report_.residual;
    if (failure_.fault == StepFault::blocked) {
        ClothContact& contact = *system_.cloth_contact();
        failure_.obstacle = contact.obstacle(state);
        if (failure_.obstacle) {
            failure_.obstacle_point = contact.nearest_point(state, *failure_.obstacle);
            for (int corner : failure_.obstacle->corner)
                if (corner < 0) failure_.obstacle_body = contact.body_of_corner(corner).name;
        }
    }
    if (failure_.fault == StepFault::not_finite) {
        const auto finite = [&](int v) {
            return vertex_planes(state.size, state.pos)(v).allFinite() &&
                   vertex_planes(state.size, state.vel)(v).allFinite();
        };
        for (int v = 0; v < n && failure_.particle < 0; ++v)
            if (!finite(v)) failure_.particle = v;
        return;
    }
    const ConstPlanes force = vertex_planes(state.size, system_.static_force());
    for (int v = 0; v < n; ++v)
        if (const double size = force(v).norm(); size > failure_.net_force) {
            failure_.net_force = size;
            failure_.particle = v;
        }
}

// Fits the next step to the estimated error of the one just taken, which goes with a known power of its length.
bool StepControl::too_inaccurate(double dt)
{
    const double error = std::max(integrator_.error_estimate(), 1e-300);
    const double fit = 0.9 * std::pow(options_.error / error, 1.0 / integrator_.info().error_power);
    if (error > options_.error && dt > 2 * floor_) {
        memory_.dt = dt * std::clamp(fit, 0.2, 0.9);
        return true;
    }
    const double next = dt * std::clamp(fit, 0.2, 2.0);
    // A step that was cut short for another reason says nothing against longer ones.
    memory_.dt = std::min(options_.longest, dt < 0.999 * memory_.dt ? std::max(memory_.dt, next) : next);
    return false;
}

// No vertex may have passed into a body. Ways are looked at in pieces short enough to be straight: the chord of a
// vertex that slides around a body for many short steps passes through it.
bool StepControl::passed_into_body(bool last)
{
    // Ways against moving bodies are cleared as they are gone.
    if (!system_.body_contact() || (moves_ && system_.cloth_contact())) return false;
    const State& state = system_.state();
    const double piece = 0.5 * system_.body_contact()->search_radius();
    if (!last && largest_distance(state, state.pos, looked_from_) < piece) return false;
    const bool passed = system_.body_contact()->crossed(state, looked_from_);
    looked_from_ = state.pos;
    return passed;
}

// Nothing feeds the cloth but the air and bodies and pins that move, whose work is not known: without them its energy
// falls, but for the waves of a scheme that keeps it on average.
bool StepControl::keeps_energy(const Cover& cover)
{
    if (moves_ || system_.wind_blows() || !integrator_.may_gain_energy()) return true;
    auto& [dt, known, first_energy, highest_kinetic, lowest_potential] = memory_;
    if (!known) {
        first_energy = cover.kinetic_before + cover.potential_before;
        lowest_potential = cover.potential_before;
        known = 1;
    }
    highest_kinetic = std::max(highest_kinetic, cover.kinetic_before);
    lowest_potential = std::min(lowest_potential, cover.potential_before);
    const double falling = 0.5 * free_mass(system_.state()) * std::pow(9.81 * cover.length, 2);
    const double moved = std::max(highest_kinetic, first_energy - lowest_potential) + falling;
    // What has just gone deep into a contact shows there only, and not in the planes that the step began with.
    system_.refresh_planes();
    return system_.kinetic_energy() + system_.potential_energy() - first_energy <= most_gain * moved;
}

// After a failure.
void StepControl::shrink(double dt)
{
    ++retries_;
    memory_.dt = 0.5 * dt;
    if (!(memory_.dt >= floor_)) throw StepFailureError(failure_);
}

StepControl::Cover StepControl::start(double room)
{
    keep(system_, &integrator_, start_);
    looked_from_ = start_.fields.pos;
    floor_ = options_.least * std::min(options_.longest, integrator_.stable_step());
    if (moves_) room = system_.longest_step(room);
    Cover cover{.begin = system_.clock().time, .length = fills() ? std::min(options_.longest, room) : room};
    if (integrator_.may_gain_energy()) {
        cover.kinetic_before = system_.kinetic_energy();
        cover.potential_before = system_.potential_energy();
    }
    shortest_ = cover.length;
    return cover;
}

// Whether a step is the last one that the cover needs.
bool StepControl::ends(const Cover& cover, double dt) const
{
    return !fills() || cover.length - cover.done - dt <= 1e-9 * cover.length;
}

StepControl::Verdict StepControl::try_step(const Cover& cover, double dt, const NewtonOptions& options, bool accurate)
{
    system_.clock() = {cover.begin + cover.done, dt};
    if (moves_) system_.move_boundary();
    // A limit that collapses on the way, or is no number, is that of a state that bursts.
    const bool sound = !fills() || dt >= floor_ || dt >= 0.5 * (cover.length - cover.done);
    bool solved = sound && solve(dt, options, accurate);
    if (sound && report_.broken_off) return Verdict::broken_off;
    const bool last = ends(cover, dt);
    if (!sound) fail(StepFault::unstable);
    if (solved && passed_into_body(last)) solved = fail(StepFault::entered_body);
    if (solved && last && !keeps_energy(cover)) solved = fail(StepFault::gained_energy);
    if (!solved) return Verdict::failed;
    return adapts() && too_inaccurate(dt) ? Verdict::inaccurate : Verdict::accepted;
}

double StepControl::advance(double room, const NewtonOptions& options, bool accurate)
{
    Cover cover = start(room);
    for (;;) {
        const double dt = next_step(cover.length - cover.done, cover.done == 0, accurate);
        if (cover.done == 0) cover.first = dt;
        if (adapts() && cover.done > 0) keep(system_, &integrator_, last_);
        switch (try_step(cover, dt, options, accurate)) {
            case Verdict::broken_off:
                restore_crossings(system_, start_);
                return_to(start_, cover.begin);
                return taken_ = 0;
            case Verdict::failed:
                if (!(0.5 * cover.first >= floor_)) note_failure(cover.first);
                return_to(start_, cover.begin);
                cover.done = 0;
                shrink(cover.first);
                continue;
            case Verdict::inaccurate:  // too_inaccurate has chosen a shorter one
                ++retries_;
                return_to(cover.done > 0 ? last_ : start_, cover.begin + cover.done);
                continue;
            case Verdict::accepted:
                break;
        }
        const bool last = ends(cover, dt);
        if (!adapts() && last) memory_.dt = std::min(options_.longest, 1.5 * memory_.dt);
        cover.done += dt;
        shortest_ = std::min(shortest_, dt);
        if (!last) continue;
        taken_ = fills() ? cover.length : dt;
        system_.clock() = {cover.begin + taken_, 0};
        return taken_;
    }
}

}  // namespace selvage
