#include "bench/accuracy/precision_cases.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include <tbb/task_arena.h>

#include "io/errors.hpp"

namespace selvage {
namespace {

RunSetting reference_setting(const std::string& integrator, double step)
{
    RunSetting setting;
    setting.integrator = integrator;
    setting.step = step;
    setting.refuse_unstable = false;
    return setting;
}

// Runs a scene with several settings at the same time, one thread for each.
std::vector<RunResult> run_all(const PrecisionScene& scene, const std::vector<RunSetting>& settings)
{
    std::vector<RunResult> results(settings.size());
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < settings.size(); ++k)
        threads.emplace_back([&scene, &setting = settings[k], &result = results[k]] {
            tbb::task_arena alone(1);
            alone.execute([&] { result = SceneRunner(scene.source, scene.overrides).run(setting); });
        });
    for (std::thread& thread : threads) thread.join();
    for (const RunResult& result : results)
        if (!result.finished) throw std::runtime_error(scene.name + ": no reference: " + result.message);
    return results;
}

// The reference of a motion: classic Runge-Kutta and velocity Verlet with steps a few times below the stability limit.
void find_motion(SceneRunner& runner, const PrecisionScene& scene, PrecisionReference& reference)
{
    Phase phase = runner.make_phase(false);
    if (phase.contact()) phase.contact()->update(phase.state());
    const double limit = make_integrator("velocity_verlet", phase)->stable_step();
    reference.integrator = "rk4";
    reference.other_integrator = "velocity_verlet";
    reference.step = scene.reference_step > 0 ? scene.reference_step : limit / 8;
    const std::vector<RunResult> runs =
        run_all(scene, {reference_setting("rk4", reference.step), reference_setting("velocity_verlet", reference.step),
                        reference_setting("rk4", 2 * reference.step)});
    reference.positions = runs[0].positions;
    reference.other = runs[1].positions;
    const auto& start = runner.model().cloth_model.cloth.positions;
    reference.refined_change = position_error(runs[2].positions, reference.positions, start);
    reference.difference = position_error(reference.other, reference.positions, start);
}

// The reference of a shape at rest: implicit Euler and the static solver, with tolerances far below those measured.
void find_rest(SceneRunner& runner, const PrecisionScene& scene, PrecisionReference& reference)
{
    reference.integrator = "implicit_euler";
    reference.other_integrator = "static";
    reference.step = runner.scene().solver.step;
    std::vector<RunSetting> settings(3, reference_setting("implicit_euler", reference.step));
    settings[1].integrator = "static";
    settings[0].tolerance = settings[1].tolerance = 1e-6;
    settings[2].tolerance = 1e-5;
    const std::vector<RunResult> runs = run_all(scene, settings);
    reference.positions = runs[0].positions;
    reference.other = runs[1].positions;
    const auto& start = runner.model().cloth_model.cloth.positions;
    reference.refined_change = position_error(runs[2].positions, reference.positions, start);
    reference.difference = position_error(reference.other, reference.positions, start);
}

void add_motions(const IntegratorInfo& info, double until, double limit, int most_steps, bool quick,
                 std::vector<RunSetting>& to)
{
    if (info.is_explicit) {
        const double scale = info.name == "rk4" ? std::sqrt(2.0) : 1;
        for (double part : quick ? std::vector<double>{0.9, 0.45} : std::vector<double>{0.9, 0.45, 0.22, 0.11}) {
            RunSetting setting = reference_setting(std::string(info.name), part * scale * limit);
            to.push_back(setting);
        }
        return;
    }
    for (double tolerance : quick ? std::vector<double>{1e-2} : std::vector<double>{1e-1, 1e-2, 1e-3}) {
        RunSetting setting = reference_setting(std::string(info.name), until);
        setting.step_tolerance = tolerance;
        setting.float_solves = tolerance > 1e-3;
        for (int steps = 4; steps <= most_steps; steps *= 2) {
            setting.step = until / steps;
            to.push_back(setting);
        }
        setting.step = until / 4;
        for (double error : {1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6}) {
            setting.step_error = error;
            if (info.has_error_estimate()) to.push_back(setting);
        }
    }
}

}  // namespace

std::string method_name(std::string_view integrator, bool adaptive)
{
    return std::string(integrator) + (adaptive ? ", adaptive" : "");
}

std::vector<PrecisionScene> precision_scenes(const std::string& name)
{
    // In none of these scenes does the cloth touch itself.
    std::vector<PrecisionScene> all = {
        {"swing",
         "Sheet of 1 m swinging from its top edge, 0.4 s",
         "builtin:hanging",
         {"sheet.resolution=33", "pins.sheet=top_edge", "solver.until=0.4"}},
        {"cantilever",
         "Stiff strip of canvas, clamped and let go, 0.2 s",
         "builtin:cantilever",
         {"sheet.width=0.2", "sheet.height=0.1", "sheet.resolution=41", "sheet.fabric=canvas", "solver.until=0.2"}},
        {"pendulum",
         "Stiff sheet of 0.2 m swinging from one edge, 0.2 s",
         "builtin:hanging",
         {"sheet.width=0.2", "sheet.height=0.2", "sheet.resolution=17", "sheet.fabric=leather", "pins.sheet=top_edge",
          "solver.until=0.2"}},
        {"card",
         "Stiff card leaning on a floor falls over, 0.1 s",
         "builtin:stress_corner",
         {"sheet.width=0.063", "sheet.height=0.088", "sheet.resolution=9", "sheet.fabric=leather",
          "sheet.rotation=[0,-65,0]", "sheet.center=[0,0,0.0304]", "body.friction=0", "solver.until=0.1"},
         false,
         0,
         1024},
        {"sphere",
         "Sheet of 1 m falling on a sphere, 0.2 s",
         "builtin:sphere",
         {"sheet.resolution=21", "solver.until=0.2"},
         false,
         5e-6,
         1024},  // implicit schemes need many steps to resolve each rebound from the sphere
        {"rest_cantilever",
         "Strip of cotton bending under its weight, at rest",
         "builtin:cantilever",
         {"sheet.resolution=81"},
         true}};
    for (PrecisionScene& scene : all) scene.overrides.push_back("contact.self=false");
    if (name.empty()) return all;
    std::vector<std::string> names;
    for (const PrecisionScene& scene : all) {
        if (scene.name == name) return {scene};
        names.push_back(scene.name);
    }
    throw InputError({"", 0, 0, "--scene"}, "`" + name + "`", "a scene of the suite", nearest_name(name, names));
}

PrecisionReference find_reference(SceneRunner& runner, const PrecisionScene& scene)
{
    PrecisionReference reference;
    const auto start = std::chrono::steady_clock::now();
    scene.at_rest ? find_rest(runner, scene, reference) : find_motion(runner, scene, reference);
    reference.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return reference;
}

std::vector<RunSetting> precision_settings(const PrecisionScene& scene, double until, double limit, bool quick)
{
    std::vector<RunSetting> settings;
    const int most_steps = scene.most_steps > 0 ? scene.most_steps : quick ? 64 : 256;
    for (const IntegratorInfo& info : integrators()) {
        if (!scene.at_rest && info.order > 0) add_motions(info, until, limit, most_steps, quick, settings);
        // Explicit schemes are left out: to come to rest they need steps at the stability limit for many simulated
        // seconds, which is never competitive.
        for (double tolerance : {1e-1, 1e-2, 1e-3, 1e-4}) {
            if (!scene.at_rest || info.is_explicit) continue;
            for (double step : {0.02, 0.05}) {
                if (quick && step != 0.02) continue;
                RunSetting setting = reference_setting(std::string(info.name), step);
                setting.tolerance = tolerance;
                setting.float_solves = true;
                settings.push_back(setting);
            }
        }
    }
    return settings;
}

}  // namespace selvage
