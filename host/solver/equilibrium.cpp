#include "host/solver/equilibrium.hpp"

#include <algorithm>
#include <cmath>

namespace selvage {
namespace {

constexpr int relax_chunk = 5;      // static iterations between two looks at interrupts and limits
constexpr int relax_chunks = 12;
constexpr int steps_between = 8;    // motion after a static attempt that did not reach the tolerance

// Minimises the static energy. It never rises, so an attempt that falls short still leaves the cloth nearer to rest.
PhaseEnd relax(Phase& phase, const EquilibriumOptions& options, DrapeProgress& progress, const AfterStep& after_step)
{
    NewtonOptions newton;
    newton.max_iterations = relax_chunk;
    newton.tolerance = options.tolerance;
    newton.linear_tolerance = 0.02;
    newton.full_stiffness = true;
    double best = 1e300;
    for (int chunk = 0; chunk < relax_chunks; ++chunk) {
        const NewtonReport report = phase.newton().relax(newton);
        if (!after_step({progress.time, 0, report.iterations, report.linear_iterations, report.residual}))
            return PhaseEnd::stopped;
        if (report.converged) return PhaseEnd::reached;
        if (report.stuck || (chunk > 3 && report.residual > 0.8 * best)) return PhaseEnd::time_limit;
        best = std::min(best, report.residual);
    }
    return PhaseEnd::time_limit;
}

}  // namespace

PhaseEnd drape_to_equilibrium(Phase& phase, const EquilibriumOptions& options, DrapeProgress& progress,
                              const AfterStep& after_step)
{
    StepControl control(phase, options.step);
    NewtonOptions newton;
    newton.max_iterations = std::min(options.newton_iterations, 3);
    newton.tolerance = 0.3 * options.tolerance;   // a looser one would let a step do nothing near the end
    while (progress.time < options.max_time || options.statics_only) {
        double residual = 0;
        if (!options.statics_only) {
            progress.time += control.advance(options.step, newton, false);
            residual = phase.newton().static_residual();
            const StepEvent event{progress.time, control.dt(), control.report().iterations,
                                  control.report().linear_iterations, residual};
            if (!after_step(event)) return PhaseEnd::stopped;
            const bool wait = --progress.hold > 0 || residual > progress.switch_residual;
            if (wait && residual > options.tolerance) continue;
        }
        const PhaseEnd end = relax(phase, options, progress, after_step);
        if (end != PhaseEnd::time_limit || options.statics_only) return end;
        progress.switch_residual = std::max(0.5 * progress.switch_residual, 2 * options.tolerance);
        progress.hold = steps_between;
    }
    return PhaseEnd::time_limit;
}

PhaseEnd drape_until(Phase& phase, const EquilibriumOptions& options, double until, double frame_interval,
                     DrapeProgress& progress, const AfterStep& after_step)
{
    StepControl control(phase, options.step);
    NewtonOptions newton;
    newton.max_iterations = options.newton_iterations;
    newton.tolerance = 1e-2;
    newton.still = 1e-2;
    while (progress.time < until - 1e-9) {
        // Steps end on frame times, so that frames show computed states and not interpolated ones.
        const double frame_end = frame_interval * (std::floor(progress.time / frame_interval + 1e-6) + 1);
        const double dt = control.advance(std::min(frame_end, until) - progress.time, newton, true);
        progress.time += dt;
        const StepEvent event{progress.time, dt, control.report().iterations, control.report().linear_iterations,
                              phase.newton().static_residual()};
        if (!after_step(event)) return PhaseEnd::stopped;
    }
    return PhaseEnd::reached;
}

}  // namespace selvage
