#include "host/run/drape_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "host/run/interrupt.hpp"
#include "host/run/measure.hpp"
#include "host/run/run_profile.hpp"
#include "host/scene/scene_phase.hpp"
#include "io/errors.hpp"

namespace selvage {
DrapeRun::DrapeRun(const Scene& scene, const RunOptions& options)
    : scene_(scene), options_(options), model_(build_scene_model(scene)), plan_(make_plan(scene, model_))
{
    check_memory(scene, plan_);
    if (plan_.phases.back().queries_bodies) query_.emplace(model_.model.bodies, cloth_reach(model_.model.cloth));
}

double DrapeRun::elapsed() const
{
    return wall_before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
}

void DrapeRun::start_phase(const std::string& name, const std::vector<Vec3>& positions,
                           const std::vector<Vec3>& velocities)
{
    const TraceScope scope("start_phase");
    const auto plan = std::find_if(plan_.phases.begin(), plan_.phases.end(),
                                   [&](const PhasePlan& phase) { return phase.name == name; });
    integrator_.reset();
    phase_.reset();  // two phases at once would double the memory
    phase_ = std::make_unique<Phase>(model_.model, phase_options(scene_, model_, *plan),
                                     plan->queries_bodies ? &*query_ : nullptr, profile_, positions, velocities);
    integrator_ = make_integrator(integrator_of(scene_), *phase_);
}

void DrapeRun::begin()
{
    recorder_ = std::make_unique<RunRecorder>(scene_, model_, options_, false);
    progress_.counters.phases["assemble"] = elapsed();
    start_afresh(plan_.coarse_start ? "coarse" : plan_.phases.front().name);
}

// Starts from the scene's own places. While coarser cloths are draped, the run's own waits for its shape.
void DrapeRun::start_afresh(const std::string& progress)
{
    const std::string phase = progress == "coarse" ? "drape" : progress;
    start_phase(phase, model_.model.cloth.positions, {});
    recorder_->open_phase(phase, phase_->topology(), -1);
    progress_.phase = progress;
    const bool shows = progress != "coarse" || !model_.sews;  // panels that have been joined unsewn are no sight
    if (scene_.output.frames && shows) recorder_->write_frame(*phase_, {}, elapsed(), true);
}

// Nothing in the folder is touched before the checkpoint has turned out to be the right one.
void DrapeRun::resume()
{
    const Checkpoint checkpoint = read_checkpoint(checkpoint_path());
    progress_ = load_progress(checkpoint, checkpoint_path(), model_);
    wall_before_ = progress_.wall_seconds;
    const std::string phase = progress_.phase == "sew" ? "sew" : "drape";
    start_phase(phase, model_.model.cloth.positions, {});
    load_particles(checkpoint, checkpoint_path(), *phase_);
    load_history(checkpoint, checkpoint_path(), *integrator_);
    recorder_ = std::make_unique<RunRecorder>(scene_, model_, options_, true);
    recorder_->open_phase(phase, phase_->topology(), progress_.frames);
}

void DrapeRun::save()
{
    const TraceScope scope("checkpoint");
    progress_.wall_seconds = elapsed();
    progress_.frames = recorder_->frame_count();
    save_run(checkpoint_path(), model_, progress_, *phase_, *integrator_);
    last_checkpoint_ = elapsed();
}

void DrapeRun::note_stability(const StepEvent& event)
{
    if (std::isinf(event.stable_step)) return;
    const bool first = std::isnan(stability_.limit);
    stability_.asked = scene_.solver.step;
    stability_.limit = first ? event.stable_step : std::min(stability_.limit, event.stable_step);
    stability_.taken = first ? event.shortest : std::min(stability_.taken, event.shortest);
    if (first && event.shortest < scene_.solver.step)
        recorder_->say(
            fmt::format("solver.step is {:.3g} s, the stability limit of {} here {:.3g} s: taking steps of {:.3g} s",
                        scene_.solver.step, integrator_of(scene_), event.stable_step, event.shortest));
}

bool DrapeRun::after_step(const StepEvent& event)
{
    note_stability(event);
    RunCounters& counters = progress_.counters;
    ++counters.steps;
    counters.newton_iterations += event.newton_iterations;
    counters.linear_iterations += event.linear_iterations;
    counters.simulated += event.dt;
    recorder_->report(progress_.phase, event, counters.steps);
    const bool shown = progress_.phase != "press" && progress_.phase != "coarse";
    if (shown) recorder_->write_frame(*phase_, event, elapsed(), false);
    // In the middle of a static attempt there is nothing to go on from: it is repeated from its start.
    if (event.dt > 0 && elapsed() - last_checkpoint_ >= scene_.output.checkpoint_interval) save();
    return !must_stop();
}

bool DrapeRun::must_stop() const
{
    const bool out_of_time = scene_.solver.max_wall > 0 && elapsed() - wall_before_ > scene_.solver.max_wall;
    return interrupt_requested() || out_of_time;
}

PhaseEnd DrapeRun::run_sewing()
{
    const TraceScope scope("sew");
    return sew(*phase_, sewing_options(scene_, plan_), progress_.sewing,
               [this](const StepEvent& event) { return after_step(event); });
}

void DrapeRun::join_seams()
{
    recorder_->close_phase();
    const std::vector<Vec3> positions = phase_->positions(), velocities = phase_->velocities();
    start_phase("drape", positions, velocities);
    recorder_->open_phase("drape", phase_->topology(), -1);
    progress_.phase = "press";
    save();
}

PhaseEnd DrapeRun::run_pressing()
{
    const TraceScope scope("press");
    return press_seams(*phase_, scene_.solver.step, progress_.pressing,
                       [this](const StepEvent& event) { return after_step(event); });
}

EquilibriumOptions DrapeRun::draping_options()
{
    EquilibriumOptions options;
    options.step.longest = scene_.solver.step;
    options.step.adaptive = scene_.solver.adaptive;
    options.step.error = scene_.solver.step_error;
    options.step.unstable = scene_.solver.unstable_step == "refuse" ? UnstableStep::refuse : UnstableStep::shrink;
    options.integrator = integrator_.get();
    options.hurries = scene_.solver.integrator != "bdf2";  // who asks for it asks for the whole motion
    options.tolerance = scene_.solver.tolerance;
    options.max_time = scene_.solver.max_time;
    options.newton_iterations = scene_.solver.newton_iterations;
    options.sleeps = scene_.solver.sleep;
    options.load_steps = scene_.solver.load_steps;
    options.stop = [this] { return must_stop(); };
    return options;
}

PhaseEnd DrapeRun::run_coarse()
{
    const TraceScope scope("coarse");
    const CoarseStart start = drape_coarse_first(scene_, model_, draping_options(), progress_.draping, profile_,
                                                 [this](const StepEvent& event) { return after_step(event); });
    if (start.stopped) return PhaseEnd::stopped;
    coarse_stages_ = start.stages;
    progress_.phase = "drape";
    if (!start.positions.empty()) {
        phase_->start_over(model_.model, start.positions);
        integrator_ = make_integrator(integrator_of(scene_), *phase_);
        if (scene_.output.frames && model_.sews) recorder_->write_frame(*phase_, {}, elapsed(), true);
        save();
    } else if (model_.sews) {
        progress_.draping = {};
        recorder_->close_phase();
        start_afresh("sew");
    }
    return PhaseEnd::reached;
}

PhaseEnd DrapeRun::run_draping()
{
    const TraceScope scope("drape");
    const EquilibriumOptions options = draping_options();
    const AfterStep hear = [this](const StepEvent& event) { return after_step(event); };
    if (scene_.solver.until == "equilibrium") return drape_to_equilibrium(*phase_, options, progress_.draping, hear);
    return drape_until(*phase_, options, std::stod(scene_.solver.until), 1 / scene_.solver.frame_rate,
                       progress_.draping, hear);
}

PhaseEnd DrapeRun::run_phases()
{
    double start = elapsed();
    const auto timed = [&](const char* name, PhaseEnd end) {
        progress_.counters.phases[name] += elapsed() - start;
        start = elapsed();
        return end;
    };
    if (progress_.phase == "coarse") {
        const PhaseEnd end = timed("coarse", run_coarse());
        if (end != PhaseEnd::reached) return end;
    }
    if (progress_.phase == "sew") {
        const PhaseEnd end = timed("sew", run_sewing());
        if (end != PhaseEnd::reached) return end;
        join_seams();
    }
    if (progress_.phase == "press") {
        const PhaseEnd end = timed("press", run_pressing());
        if (end != PhaseEnd::reached) return end;
        progress_.phase = "drape";
        if (scene_.output.frames) recorder_->write_frame(*phase_, {}, elapsed(), true);
        save();
    }
    return timed("drape", run_draping());
}

// Cloth that started with intersections has come to rest only when none is left.
RunOutcome DrapeRun::conclude_at_rest()
{
    ClothContact* cloth = phase_->cloth_contact();
    if (!cloth) return conclude(RunStatus::converged, "");
    cloth->begin(phase_->state());
    const int left = cloth->counts().tangles + cloth->counts().inside;
    if (left == 0) return conclude(RunStatus::converged, "");
    return conclude(
        RunStatus::time_limit,
        fmt::format("at rest, but {} pairs of triangles intersect and {} vertices are inside a body; they did so "
                    "at the start: `selvage check` shows where",
                    cloth->counts().tangles, cloth->counts().inside));
}

RunOutcome DrapeRun::conclude(RunStatus status, const std::string& message)
{
    const TraceScope scope("conclude");
    const double residual = phase_->newton().static_residual();
    const StepEvent event{progress_.phase == "sew" ? progress_.sewing.time : progress_.draping.time, 0, 0, 0, residual};
    // A garment that is still being pressed is not yet the draped one that run.h5 begins with.
    if (progress_.phase != "press") recorder_->write_frame(*phase_, event, elapsed(), true);
    save();
    recorder_->close_phase();
    recorder_->conclude(status, progress_.draping.time, *phase_, plan_, query_ ? &*query_ : nullptr, progress_.counters,
                        stability_, coarse_stages_, profile_, residual, elapsed(), message);
    const bool complete = status == RunStatus::converged || status == RunStatus::finished;
    if (complete && !scene_.output.keep_checkpoint) std::filesystem::remove(checkpoint_path());
    int code = complete ? 0 : 4;
    if (status == RunStatus::diverged) code = 3;
    if (status == RunStatus::interrupted) code = interrupt_exit_code();
    return {status, code, message};
}

RunOutcome DrapeRun::conclude_stopped()
{
    if (interrupt_requested())
        return conclude(RunStatus::interrupted, "interrupted: the state is saved, --resume goes on from here");
    return conclude(RunStatus::time_limit,
                    fmt::format("stopped after {:.3g} s (solver.max_wall); --resume goes on", scene_.solver.max_wall));
}

std::string DrapeRun::why_not_done() const
{
    if (progress_.phase == "drape")
        return fmt::format("not at rest after {:.1f} s (solver.max_time): relative force residual {:.2e}, asked {:.2e}",
                           progress_.draping.time, progress_.draping.residual, scene_.solver.tolerance);
    const Cloth& cloth = model_.model.cloth;
    const std::vector<double> gaps = measure_seams(cloth, phase_->positions());
    const auto worst = std::max_element(gaps.begin(), gaps.end());
    const Seam& seam = cloth.seams[std::size_t(worst - gaps.begin())];
    const auto side = [&](int index) {
        const OutlineSamples& edge = cloth.outline[index];
        return cloth.panels[edge.panel].name + "[" + std::to_string(edge.edge) + "]";
    };
    return fmt::format("the seam of {} and {} is still open by {:.1f} mm after {:.1f} s (seams.max_time)",
                       side(seam.side_a), side(seam.side_b), 1000 * *worst, scene_.seams.max_time);
}

RunOutcome DrapeRun::execute()
{
    options_.resume ? resume() : begin();
    try {
        const PhaseEnd end = run_phases();
        if (end == PhaseEnd::stopped) return conclude_stopped();
        if (end == PhaseEnd::time_limit) return conclude(RunStatus::time_limit, why_not_done());
        const bool timed = scene_.solver.until != "equilibrium";
        return timed ? conclude(RunStatus::finished, "") : conclude_at_rest();
    } catch (const UnstableStepError& error) {
        throw InputError(scene_.place("solver.step"), fmt::format("{:.6g} s", scene_.solver.step),
                         fmt::format("at most the stability limit of {}, {:.3g} s at {:.3g} s of simulated time, as "
                                     "solver.unstable_step is refuse",
                                     integrator_of(scene_), error.limit, progress_.draping.time));
    } catch (const DivergenceError& error) {
        return conclude(RunStatus::diverged, std::string("diverged: ") + error.what());
    }
}

RunOutcome run_drape(const Scene& scene, const RunOptions& options)
{
    std::optional<tbb::global_control> limit;
    if (scene.solver.threads > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(scene.solver.threads));
    std::optional<Trace> trace;
    if (options.profile) trace.emplace();
    const TraceUse use(trace ? &*trace : nullptr);
    const RunOutcome outcome = DrapeRun(scene, options).execute();
    if (trace) conclude_profile(*trace, options.folder);
    return outcome;
}

}  // namespace selvage
