#include "host/solver/equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "host/solver/sleep.hpp"

namespace selvage {
namespace {

constexpr int relax_chunk = 5;      // static iterations between two looks at interrupts and limits
constexpr int relax_chunks = 12;
constexpr double first_load = 0.05;   // part of the weight at the first of several load steps
constexpr int steps_between = 8;    // motion after a static attempt that did not reach the tolerance
constexpr double stride = 2;        // steps towards rest, of those of a motion: only where they lead counts

// What a static attempt that is interrupted gives back, so that a resumed run repeats it from its start.
struct SavedShape {
    std::vector<real> pos, vel, anchor, limit, hinge_anchor, pairs;
};

SavedShape shape_of(const Phase& phase)
{
    const State& s = phase.state();
    const ClothContact* cloth = phase.cloth_contact();
    return {s.pos, s.vel, s.friction_anchor, s.friction_limit, s.hinge_anchor,
            cloth ? cloth->memory() : std::vector<real>{}};
}

void restore(Phase& phase, const SavedShape& saved)
{
    State& state = phase.state();
    if (phase.cloth_contact()) phase.cloth_contact()->memory() = saved.pairs;
    state.pos = saved.pos;
    state.vel = saved.vel;
    state.friction_anchor = saved.anchor;
    state.friction_limit = saved.limit;
    state.hinge_anchor = saved.hinge_anchor;
}

// Minimises the static energy. It never rises, so an attempt that falls short still leaves the cloth nearer to rest.
PhaseEnd relax(Phase& phase, const EquilibriumOptions& options, DrapeProgress& progress, const AfterStep& after_step)
{
    NewtonOptions newton;
    newton.max_iterations = relax_chunk;
    newton.tolerance = options.tolerance;
    newton.linear_tolerance = 0.02;
    newton.full_stiffness = true;
    newton.stop = &options.stop;
    const SavedShape start = shape_of(phase);
    double best = 1e300;
    for (int chunk = 0; chunk < relax_chunks; ++chunk) {
        const NewtonReport report = phase.newton().relax(newton);
        if (report.broken_off || !after_step({progress.time, 0, report.iterations, report.linear_iterations, report.residual})) {
            restore(phase, start);
            return PhaseEnd::stopped;
        }
        if (report.converged) return PhaseEnd::reached;
        const bool buckles = report.blind == report.iterations && report.iterations > 0;   // inertia has to lead it on
        if (chunk + 1 == relax_chunks || report.stuck || buckles) progress.residual = report.residual;
        if (report.stuck || buckles || (chunk > 3 && report.residual > 0.8 * best)) return PhaseEnd::time_limit;
        best = std::min(best, report.residual);
    }
    return PhaseEnd::time_limit;
}

bool nearly_balanced(const Phase& phase, const EquilibriumOptions& options, const DrapeProgress& progress)
{
    if (progress.time < phase.motion_end()) return false;
    return progress.residual <= options.tolerance ||
           (progress.hold <= 0 && progress.residual <= progress.switch_residual);
}

// The integrator of the options, or one that is made here.
Integrator& chosen(const EquilibriumOptions& options, Phase& phase, std::unique_ptr<Integrator>& own)
{
    if (options.integrator) return *options.integrator;
    own = make_integrator("implicit_euler", phase);
    return *own;
}

StepOptions starting_at(double time, StepOptions options)
{
    options.start = time;
    return options;
}

StepEvent event_of(const StepControl& control, const DrapeProgress& progress)
{
    return {progress.time,     control.taken(),       control.report().iterations, control.report().linear_iterations,
            progress.residual, control.stable_step(), control.shortest()};
}

// Whether a step may be left unsolved: what an iteration leaves over, a damped scheme of first order makes up for later.
// Friction remembers the way, though: who lets the weight grow in steps asks for a way that is followed.
bool may_hurry(const Integrator& integrator, const EquilibriumOptions& options)
{
    return !integrator.info().is_explicit && integrator.info().order <= 1 && !options.step.adaptive &&
           options.load_steps == 1;
}

void wake_all(Phase& phase, DrapeProgress& progress)
{
    if (progress.asleep > 0) wake(phase);
    progress.asleep = 0;
}

// Whether all is at rest where what is awake is.
PhaseEnd rest_of_all(Phase& phase, const EquilibriumOptions& options, DrapeProgress& progress)
{
    wake_all(phase, progress);
    progress.residual = phase.newton().static_residual();
    return progress.residual <= options.tolerance ? PhaseEnd::reached : PhaseEnd::time_limit;
}

// Rest under the present weight.
PhaseEnd come_to_rest(Phase& phase, Integrator& integrator, const EquilibriumOptions& options, DrapeProgress& progress,
                      const AfterStep& after_step)
{
    const bool hurries = may_hurry(integrator, options);
    StepOptions steps = starting_at(progress.time, options.step);
    if (hurries) steps.longest *= stride;
    StepControl control(phase, integrator, steps);
    if (progress.dt > 0) control.set_dt(progress.dt);
    NewtonOptions newton;
    newton.stop = &options.stop;
    newton.tolerance = 0.3 * options.tolerance;   // a looser one would let a step do nothing near the end
    for (;;) {
        if (nearly_balanced(phase, options, progress)) {
            const bool was_part = progress.asleep > 0;
            PhaseEnd end = relax(phase, options, progress, after_step);
            if (end == PhaseEnd::stopped) return end;
            if (was_part && end == PhaseEnd::reached) end = rest_of_all(phase, options, progress);
            wake_all(phase, progress);
            if (end == PhaseEnd::reached) return end;
            integrator.restart();
            if (was_part && progress.residual <= 10 * options.tolerance) continue;   // the rest is near its place
            progress.switch_residual = std::max(0.5 * progress.switch_residual, 2 * options.tolerance);
            progress.hold = steps_between;
        }
        if (progress.time >= options.max_time) {
            wake_all(phase, progress);
            return PhaseEnd::time_limit;
        }
        const bool follows = progress.time < phase.motion_end();   // bodies or pins, whose way counts
        newton.max_iterations = std::min(options.newton_iterations, hurries && !follows ? 1 : 3);
        progress.time += control.advance(follows ? options.step.longest : steps.longest, newton, false);
        if (control.report().broken_off) return PhaseEnd::stopped;
        progress.dt = control.dt();
        progress.residual = phase.newton().static_residual();
        if (hurries && !follows && options.sleeps) rest_in_places(phase, progress.asleep);
        --progress.hold;
        if (!after_step(event_of(control, progress))) return PhaseEnd::stopped;
    }
}

}  // namespace

PhaseEnd drape_to_equilibrium(Phase& phase, const EquilibriumOptions& options, DrapeProgress& progress,
                              const AfterStep& after_step)
{
    std::unique_ptr<Integrator> own;
    Integrator& integrator = chosen(options, phase, own);
    const auto whole = phase.params().gravity;
    const double first = std::log(first_load);
    PhaseEnd end = PhaseEnd::reached;
    while (progress.load < options.load_steps && end == PhaseEnd::reached) {
        const int left = options.load_steps - 1 - progress.load;
        const double part = left == 0 ? 1 : std::exp(first * left / (options.load_steps - 1));
        auto& gravity = phase.params().gravity;
        gravity.acceleration_x = part * whole.acceleration_x;
        gravity.acceleration_y = part * whole.acceleration_y;
        gravity.acceleration_z = part * whole.acceleration_z;
        end = come_to_rest(phase, integrator, options, progress, after_step);
        if (end == PhaseEnd::reached && left > 0) progress = DrapeProgress{.time = progress.time, .load = progress.load};
        if (end == PhaseEnd::reached) ++progress.load;
    }
    phase.params().gravity = whole;
    return end;
}

PhaseEnd drape_until(Phase& phase, const EquilibriumOptions& options, double until, double frame_interval,
                     DrapeProgress& progress, const AfterStep& after_step)
{
    std::unique_ptr<Integrator> own;
    StepControl control(phase, chosen(options, phase, own), starting_at(progress.time, options.step));
    if (progress.dt > 0) control.set_dt(progress.dt);
    NewtonOptions newton;
    newton.max_iterations = options.newton_iterations;
    newton.tolerance = 1e-2;
    newton.still = 3e-2;
    newton.decrement = 1e-2;
    newton.linear_tolerance = 0.2;
    newton.stop = &options.stop;
    newton.most_left = 0.12 * phase.edge_length();
    while (progress.time < until - 1e-9) {
        // Steps end on frame times, so that frames show computed states and not interpolated ones.
        const double frame_end = frame_interval * (std::floor(progress.time / frame_interval + 1e-6) + 1);
        progress.time += control.advance(std::min(frame_end, until) - progress.time, newton, true);
        if (control.report().broken_off) return PhaseEnd::stopped;
        progress.dt = control.dt();
        StepEvent event = event_of(control, progress);
        event.residual = phase.newton().static_residual();
        if (!after_step(event)) return PhaseEnd::stopped;
    }
    return PhaseEnd::reached;
}

}  // namespace selvage
