#include "host/solver/sewing.hpp"

#include <algorithm>
#include <cmath>

#include "host/solver/launch.hpp"

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
    const int vs = s.size.vertex_stride;
    return std::sqrt(max_items(int(stitches.size()), [&](int k) {
        double squared = 0;
        for (int c = 0; c < 3; ++c) {
            const double d = s.pos[c * vs + stitches[k][0]] - s.pos[c * vs + stitches[k][1]];
            squared += d * d;
        }
        return squared;
    }));
}

PhaseEnd sew(Phase& phase, const SewingOptions& options, SewingProgress& progress, const AfterStep& after_step)
{
    StepControl control(phase, options.step);
    NewtonOptions newton;
    newton.max_iterations = 3;   // on the way to a closed seam accuracy in time is worth nothing
    newton.tolerance = 1e-2;
    const double first_stiffness = phase.params().seam.stiffness;
    while (progress.time < options.max_time) {
        progress.time += control.advance(options.step, newton, false);
        const double gap = largest_gap(phase);
        const double energy = phase.newton().energy_of("membrane") + phase.newton().energy_of("bending");
        const double change = std::abs(energy - progress.elastic_energy) / std::max(energy, 1e-12);
        progress.elastic_energy = energy;
        progress.steps_without_gain = gap < 0.98 * progress.best_gap ? 0 : progress.steps_without_gain + 1;
        progress.best_gap = std::min(progress.best_gap, gap);
        const StepEvent event{progress.time, control.dt(), control.report().iterations,
                              control.report().linear_iterations, gap / options.closed};
        if (!after_step(event)) return PhaseEnd::stopped;
        const bool settled = change <= options.energy_tolerance || progress.steps_without_gain >= patience;
        if (gap <= options.closed && (settled || gap <= 0.25 * options.closed)) return PhaseEnd::reached;
        if (gap > options.closed && progress.steps_without_gain >= patience &&
            phase.params().seam.stiffness < strongest_pull * first_stiffness) {
            phase.params().seam.stiffness *= 2;
            phase.params().seam.force_limit *= 1.5;
            progress.steps_without_gain = 0;
        }
    }
    return PhaseEnd::time_limit;
}

PhaseEnd press_seams(Phase& phase, double step, const AfterStep& after_step)
{
    const Params worn = phase.params();
    phase.params().bending.scale *= press_bending;
    phase.params().friction.scale = 0;
    phase.params().gravity = {};
    StepControl control(phase, step);
    NewtonOptions newton;
    newton.max_iterations = 2;
    double time = 0;
    PhaseEnd end = PhaseEnd::reached;
    for (int k = 0; k < press_steps && end == PhaseEnd::reached; ++k) {
        time += control.advance(step, newton, false);
        if (!after_step({time, control.dt(), control.report().iterations, control.report().linear_iterations,
                         control.report().residual}))
            end = PhaseEnd::stopped;
    }
    phase.params() = worn;
    return end;
}

}  // namespace selvage
