#include "bench/harness/scene_runner.hpp"

#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>

#include "host/scene/run_settings.hpp"
#include "io/errors.hpp"
#include "io/scene/read_scene.hpp"

namespace selvage {

double thread_seconds()
{
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

SceneRunner::SceneRunner(const std::string& source, const std::vector<std::string>& overrides)
    : scene_(read_scene(source, overrides)), model_(build_scene_model(scene_)),
      plan_(make_plan(scene_, model_).phases.back())
{
    if (plan_.queries_bodies) query_.emplace(model_.cloth_model.bodies, cloth_reach(model_.cloth_model.cloth));
}

Phase SceneRunner::make_phase(bool float_solves, const std::vector<Vec3>& velocities)
{
    PhaseOptions options = phase_options(scene_, model_, false);
    options.float_solves = float_solves;
    return Phase(model_.cloth_model, options, query_ ? &*query_ : nullptr, profile_, model_.cloth_model.cloth.positions,
                 velocities);
}

void SceneRunner::move(Phase& phase, const RunSetting& setting, RunResult& result) const
{
    const auto integrator = make_integrator(setting.integrator, phase);
    StepOptions steps;
    steps.longest = setting.step;
    steps.moves_boundary = true;
    steps.unstable = setting.refuse_unstable ? UnstableStep::refuse : UnstableStep::shrink;
    const auto count = [&](const StepEvent& event) {
        ++result.steps;
        result.newton_iterations += event.newton_iterations;
        result.linear_iterations += event.linear_iterations;
        return true;
    };
    if (setting.step_error > 0) {
        steps.adaptive = true;
        steps.error = setting.step_error;
    }
    EquilibriumOptions options;
    options.step = steps;
    options.integrator = integrator.get();
    options.tolerance = setting.tolerance;
    options.step_tolerance = setting.step_tolerance;
    options.max_time = scene_.solver.max_time;
    options.newton_iterations = scene_.solver.newton_iterations;
    DrapeProgress progress;
    if (scene_.until().equilibrium) {
        result.finished = drape_to_equilibrium(phase, options, progress, count) == PhaseEnd::reached;
        if (!result.finished) result.message = "not at rest within solver.max_time";
        return;
    }
    const double until = scene_.until().time;
    // One frame, so that no step is cut short for it.
    result.finished = drape_until(phase, options, until, until, progress, count) == PhaseEnd::reached;
}

RunResult SceneRunner::run(const RunSetting& setting)
{
    RunResult result;
    Phase phase = make_phase(setting.float_solves);
    const auto start = std::chrono::steady_clock::now();
    const double cpu_start = thread_seconds();
    try {
        move(phase, setting, result);
    } catch (const DivergenceError& error) {
        result.message = error.what();
    } catch (const UnstableStepError& error) {
        result.message = error.what();
    }
    result.cpu = thread_seconds() - cpu_start;
    result.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.positions = phase.positions();
    return result;
}

double position_error(const std::vector<Vec3>& positions, const std::vector<Vec3>& reference,
                      const std::vector<Vec3>& start)
{
    double error = 0, displacement = 0;  // sums of squares [m^2]
    for (std::size_t v = 0; v < reference.size(); ++v) {
        error += (positions[v] - reference[v]).squaredNorm();
        displacement += (reference[v] - start[v]).squaredNorm();
    }
    return std::isfinite(error) ? std::sqrt(error / displacement) : std::numeric_limits<double>::infinity();
}

}  // namespace selvage
