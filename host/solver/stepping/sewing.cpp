#include "host/solver/stepping/sewing.hpp"

#include <algorithm>
#include <cmath>

#include "host/parallel/launch.hpp"
#include "host/solver/state/planes.hpp"

namespace selvage {
namespace {

// How seams are pulled closed and pressed. Chosen by hand on the built-in garments; not measured one by one.
struct SewingTuning {
    static constexpr int stall_limit = 12;          // steps without headway before seams are pulled harder
    static constexpr double headway = 0.98;         // factor by which the largest gap must shrink to count as headway
    static constexpr double stiffness_growth = 2;   // factor of the seam's stiffness when it is pulled harder
    static constexpr double limit_growth = 1.5;     // factor of the seam's force limit at the same time
    static constexpr double strongest_pull = 1e3;   // largest stiffness, times the scene's own seam stiffness
    static constexpr double closed_at_once = 0.25;  // times the gap of a closed seam: below it nothing has to settle
    static constexpr double press_bending = 100;    // times the fabric's bending rigidity: laps at seams fold open
    static constexpr int press_steps = 20;          // of pressing
};

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
    const bool settled =
        progress.energy_change <= options.energy_tolerance || progress.steps_without_gain >= SewingTuning::stall_limit;
    return progress.gap <= options.closed && (settled || progress.gap <= SewingTuning::closed_at_once * options.closed);
}

void pull_harder_if_stuck(Phase& phase, const SewingOptions& options, SewingProgress& progress)
{
    if (progress.gap <= options.closed || progress.steps_without_gain < SewingTuning::stall_limit ||
        phase.params().seam.stiffness >= SewingTuning::strongest_pull * options.first_stiffness)
        return;
    phase.params().seam.stiffness *= SewingTuning::stiffness_growth;
    phase.params().seam.force_limit *= SewingTuning::limit_growth;
    progress.steps_without_gain = 0;
}

void note_step(const Phase& phase, SewingProgress& progress)
{
    const System& system = phase.system();
    const double energy = system.energy_of(EnergyFamily::membrane) + system.energy_of(EnergyFamily::bending);
    progress.gap = largest_gap(phase);
    progress.energy_change = std::abs(energy - progress.elastic_energy) / std::max(energy, 1e-12);
    progress.elastic_energy = energy;
    progress.steps_without_gain =
        progress.gap < SewingTuning::headway * progress.best_gap ? 0 : progress.steps_without_gain + 1;
    progress.best_gap = std::min(progress.best_gap, progress.gap);
}

}  // namespace

PhaseEnd sew(Phase& phase, const SewingOptions& options, SewingProgress& progress, const AfterStep& after_step)
{
    const std::unique_ptr<Integrator> euler = make_integrator("implicit_euler", phase);
    StepControl control(phase, *euler, {.longest = options.step}, progress.steps);
    NewtonOptions newton;
    newton.max_iterations = 3;  // on the way to a closed seam accuracy in time is worth nothing
    newton.tolerance = 1e-2;
    const Clock& clock = phase.system().clock();
    while (!closed(options, progress)) {
        if (clock.time >= options.max_time) return PhaseEnd::time_limit;
        pull_harder_if_stuck(phase, options, progress);
        control.advance(options.step, newton, false);
        progress.steps = control.memory();
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
    phase.params().bending.scale *= SewingTuning::press_bending;
    phase.params().plate.scale *= SewingTuning::press_bending;
    phase.params().spring.bend_scale *= SewingTuning::press_bending;
    phase.params().friction.scale = 0;
    phase.params().velocity_rule.friction = 0;
    phase.params().bending_hysteresis.scale = 0;
    phase.params().gravity = {};
    const std::unique_ptr<Integrator> euler = make_integrator("implicit_euler", phase);
    StepControl control(phase, *euler, {.longest = step}, progress.steps);
    NewtonOptions newton;
    newton.max_iterations = 2;
    const Clock start = phase.system().clock();  // pressing takes none of the run's time
    PhaseEnd end = PhaseEnd::reached;
    while (progress.step < SewingTuning::press_steps && end == PhaseEnd::reached) {
        control.advance(step, newton, false);
        phase.system().clock() = start;
        ++progress.step;
        progress.steps = control.memory();
        if (!after_step({start.time, control.taken(), control.report().iterations, control.report().linear_iterations,
                         control.report().residual}))
            end = PhaseEnd::stopped;
    }
    phase.params() = worn;
    return end;
}

}  // namespace selvage
