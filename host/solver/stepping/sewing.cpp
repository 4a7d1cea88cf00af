#include "host/solver/stepping/sewing.hpp"

#include <algorithm>
#include <cmath>

#include "host/parallel/launch.hpp"
#include "host/solver/state/planes.hpp"

namespace selvage {
namespace {

constexpr int patience = 12;            // steps without headway before seams are pulled harder
constexpr double strongest_pull = 1e3;  // times the scene's own seam stiffness
constexpr double press_bending = 100;   // times the fabric's bending rigidity
constexpr int press_steps = 20;

}  // namespace

double largest_gap(const Phase& phase)
{
    const State& s = phase.state();
    const auto& stitches = phase.topology().stitches;
    const ConstPlanes x = vertex_planes(s.size, s.pos);
    return std::sqrt(max_items(int(stitches.size()), [&](int k) {
        const Vec3 d = x(stitches[k][0]) - x(stitches[k][1]);
        double squared = 0;
        for (int c = 0; c < 3; ++c) squared += d[c] * d[c];
        return squared;
    }));
}

namespace {

bool closed(const SewingOptions& options, const SewingProgress& progress)
{
    const bool settled = progress.energy_change <= options.energy_tolerance || progress.steps_without_gain >= patience;
    return progress.gap <= options.closed && (settled || progress.gap <= 0.25 * options.closed);
}

void pull_harder_if_stuck(Phase& phase, const SewingOptions& options, SewingProgress& progress)
{
    if (progress.gap <= options.closed || progress.steps_without_gain < patience ||
        phase.params().seam.stiffness >= strongest_pull * options.first_stiffness)
        return;
    phase.params().seam.stiffness *= 2;
    phase.params().seam.force_limit *= 1.5;
    progress.steps_without_gain = 0;
}

void note_step(const Phase& phase, SewingProgress& progress)
{
    const System& system = phase.system();
    const double energy = system.energy_of(EnergyFamily::membrane) + system.energy_of(EnergyFamily::bending);
    progress.gap = largest_gap(phase);
    progress.energy_change = std::abs(energy - progress.elastic_energy) / std::max(energy, 1e-12);
    progress.elastic_energy = energy;
    progress.steps_without_gain = progress.gap < 0.98 * progress.best_gap ? 0 : progress.steps_without_gain + 1;
    progress.best_gap = std::min(progress.best_gap, progress.gap);
}

}  // namespace

PhaseEnd sew(Phase& phase, const SewingOptions& options, SewingProgress& progress, const AfterStep& after_step)
{
    const std::unique_ptr<Integrator> euler = make_integrator("implicit_euler", phase);
    StepControl control(phase, *euler, {.longest = options.step});
    if (progress.dt > 0) control.set_dt(progress.dt);
    NewtonOptions newton;
    newton.max_iterations = 3;  // on the way to a closed seam accuracy in time is worth nothing
    newton.tolerance = 1e-2;
    const Clock& clock = phase.system().clock();
    while (!closed(options, progress)) {
        if (clock.time >= options.max_time) return PhaseEnd::time_limit;
        pull_harder_if_stuck(phase, options, progress);
        control.advance(options.step, newton, false);
        progress.dt = control.dt();
        note_step(phase, progress);
        if (!after_step({clock.time, control.taken(), control.report().iterations, control.report().linear_iterations,
                         progress.gap / options.closed}))
            return PhaseEnd::stopped;
    }
    return PhaseEnd::reached;
}

PhaseEnd press_seams(Phase& phase, double step, PressProgress& progress, const AfterStep& after_step)
{
    const Params worn = phase.params();
    phase.params().bending.scale *= press_bending;
    phase.params().plate.scale *= press_bending;
    phase.params().spring.bend_scale *= press_bending;
    phase.params().friction.scale = 0;
    phase.params().velocity_rule.friction = 0;
    phase.params().bending_hysteresis.scale = 0;
    phase.params().gravity = {};
    const std::unique_ptr<Integrator> euler = make_integrator("implicit_euler", phase);
    StepControl control(phase, *euler, {.longest = step});
    if (progress.dt > 0) control.set_dt(progress.dt);
    NewtonOptions newton;
    newton.max_iterations = 2;
    const Clock start = phase.system().clock();  // pressing takes none of the run's time
    PhaseEnd end = PhaseEnd::reached;
    while (progress.step < press_steps && end == PhaseEnd::reached) {
        control.advance(step, newton, false);
        phase.system().clock() = start;
        ++progress.step;
        progress.dt = control.dt();
        if (!after_step({start.time, control.taken(), control.report().iterations, control.report().linear_iterations,
                         control.report().residual}))
            end = PhaseEnd::stopped;
    }
    phase.params() = worn;
    return end;
}

}  // namespace selvage
