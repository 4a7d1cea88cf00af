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
#include "io/atomic_file.hpp"
#include "io/errors.hpp"
#include "io/scene/scene.hpp"

namespace selvage {
DrapeRun::DrapeRun(const Scene& scene, const RunOptions& options, RunFolder& folder)
    : options_(options), folder_(folder), model_(build_scene_model(scene)), plan_(make_plan(scene, model_))
{
    check_memory(scene, plan_);
    settings_ = make_run_settings(scene, model_);
    if (meets_bodies(settings_.cloth.draping.params))
        query_.emplace(model_.cloth_model.bodies, cloth_reach(model_.cloth_model.cloth));
}

double DrapeRun::elapsed() const
{
    return wall_before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
}

void DrapeRun::start_phase(RunStage stage, const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities)
{
    const TraceScope scope("start_phase");
    const PhaseOptions& options = stage == RunStage::sew ? settings_.cloth.sewing : settings_.cloth.draping;
    integrator_.reset();
    phase_.reset();  // two phases at once would double the memory
    phase_ = std::make_unique<Phase>(model_.cloth_model, options, meets_bodies(options.params) ? &*query_ : nullptr,
                                     profile_, positions, velocities);
    integrator_ = make_integrator(word_of(settings_.integrator), *phase_);
}

void DrapeRun::begin()
{
    recorder_ = std::make_unique<RunRecorder>(settings_, model_, folder_, options_.quiet, false);
    progress_.counters.phases["assemble"] = elapsed();
    start_afresh(plan_.coarse_start ? RunStage::coarse : plan_.phases.front().stage);
}

// Starts from the scene's own places. While coarser cloths are draped, the run's own waits for its shape.
void DrapeRun::start_afresh(RunStage stage)
{
    start_phase(stage, model_.cloth_model.cloth.positions, {});
    recorder_->open_phase(stage, phase_->topology(), -1);
    progress_.stage = stage;
    // Panels that have been joined unsewn are no sight.
    const bool shows = stage != RunStage::coarse || !model_.sews;
    if (settings_.output.frames && shows) recorder_->write_frame(*phase_, {}, elapsed(), true);
}

// Nothing in the folder is touched before the checkpoint has turned out to be the right one.
void DrapeRun::resume()
{
    const Checkpoint checkpoint = read_checkpoint(checkpoint_path());
    progress_ = load_progress(checkpoint, checkpoint_path(), model_);
    wall_before_ = progress_.wall_seconds;
    start_phase(progress_.stage, model_.cloth_model.cloth.positions, {});
    load_particles(checkpoint, checkpoint_path(), *phase_);
    load_history(checkpoint, checkpoint_path(), *integrator_);
    recorder_ = std::make_unique<RunRecorder>(settings_, model_, folder_, options_.quiet, true);
    recorder_->open_phase(progress_.stage, phase_->topology(), progress_.frames);
}

void DrapeRun::save()
{
    const TraceScope scope("checkpoint");
    progress_.wall_seconds = elapsed();
    progress_.frames = recorder_->frame_count();
    folder_.write([&](const std::string& folder) {
        save_run(folder + "/checkpoint.h5", model_, progress_, *phase_, *integrator_);
    });
    last_checkpoint_ = elapsed();
}

void DrapeRun::note_stability(const StepEvent& event)
{
    if (std::isinf(event.stable_step)) return;
    const bool first = std::isnan(stability_.limit);
    stability_.asked = settings_.drape.step.longest;
    stability_.limit = first ? event.stable_step : std::min(stability_.limit, event.stable_step);
    stability_.taken = first ? event.shortest : std::min(stability_.taken, event.shortest);
    if (first && event.shortest < settings_.drape.step.longest)
        recorder_->say(fmt::format(
            "solver.step is {:.3g} s, the stability limit of {} here {:.3g} s: taking steps of {:.3g} s",
            settings_.drape.step.longest, word_of(settings_.integrator), event.stable_step, event.shortest));
}

bool DrapeRun::after_step(const StepEvent& event)
{
    note_stability(event);
    RunCounters& counters = progress_.counters;
    ++counters.steps;
    counters.newton_iterations += event.newton_iterations;
    counters.linear_iterations += event.linear_iterations;
    counters.simulated += event.dt;
    const bool drapes = progress_.stage == RunStage::drape || progress_.stage == RunStage::coarse;
    const std::string integrator(event.integrator);
    if (drapes && !integrator.empty() && std::ranges::count(counters.integrators, integrator) == 0)
        counters.integrators.push_back(integrator);
    recorder_->report(progress_.stage, event, counters.steps);
    const bool shown = progress_.stage != RunStage::press && progress_.stage != RunStage::coarse;
    if (shown) recorder_->write_frame(*phase_, event, elapsed(), false);
    // In the middle of a static attempt there is nothing to go on from: it is repeated from its start.
    if (event.dt > 0 && elapsed() - last_checkpoint_ >= settings_.output.checkpoint_interval) save();
    return !must_stop();
}

bool DrapeRun::must_stop() const
{
    const bool out_of_time = settings_.max_wall > 0 && elapsed() - wall_before_ > settings_.max_wall;
    return interrupt_requested() || out_of_time;
}

PhaseEnd DrapeRun::run_sewing()
{
    const TraceScope scope("sew");
    return sew(*phase_, settings_.cloth.sew, progress_.sewing,
               [this](const StepEvent& event) { return after_step(event); });
}

void DrapeRun::join_seams()
{
    recorder_->close_phase();
    const std::vector<Vec3> positions = phase_->positions(), velocities = phase_->velocities();
    start_phase(RunStage::drape, positions, velocities);
    recorder_->open_phase(RunStage::drape, phase_->topology(), -1);
    progress_.stage = RunStage::press;
    save();
}

PhaseEnd DrapeRun::run_pressing()
{
    const TraceScope scope("press");
    return press_seams(*phase_, settings_.drape.step.longest, progress_.pressing,
                       [this](const StepEvent& event) { return after_step(event); });
}

EquilibriumOptions DrapeRun::draping_options() const
{
    EquilibriumOptions options = settings_.drape;
    options.integrator = integrator_.get();
    options.stop = [this] { return must_stop(); };
    return options;
}

PhaseEnd DrapeRun::run_coarse()
{
    const TraceScope scope("coarse");
    const CoarseStart start =
        drape_coarse_first(settings_, model_, draping_options(), phase_->system().clock(), progress_.draping, profile_,
                           [this](const StepEvent& event) { return after_step(event); });
    if (start.stopped) return PhaseEnd::stopped;
    coarse_stages_ = start.stages;
    progress_.stage = RunStage::drape;
    if (!start.positions.empty()) {
        phase_->start_over(model_.cloth_model, start.positions);
        integrator_ = make_integrator(word_of(settings_.integrator), *phase_);
        if (settings_.output.frames && model_.sews) recorder_->write_frame(*phase_, {}, elapsed(), true);
        save();
    } else if (model_.sews) {
        progress_.draping = {};
        recorder_->close_phase();
        start_afresh(RunStage::sew);
    }
    return PhaseEnd::reached;
}

PhaseEnd DrapeRun::run_draping()
{
    const TraceScope scope("drape");
    const EquilibriumOptions options = draping_options();
    const AfterStep hear = [this](const StepEvent& event) { return after_step(event); };
    if (settings_.until.equilibrium) return drape_to_equilibrium(*phase_, options, progress_.draping, hear);
    return drape_until(*phase_, options, settings_.until.time, 1 / settings_.frame_rate, progress_.draping, hear);
}

PhaseEnd DrapeRun::run_phases()
{
    double start = elapsed();
    const auto timed = [&](RunStage stage, PhaseEnd end) {
        progress_.counters.phases[text_of(stage)] += elapsed() - start;
        start = elapsed();
        return end;
    };
    if (progress_.stage == RunStage::coarse) {
        const PhaseEnd end = timed(RunStage::coarse, run_coarse());
        if (end != PhaseEnd::reached) return end;
    }
    if (progress_.stage == RunStage::sew) {
        const PhaseEnd end = timed(RunStage::sew, run_sewing());
        if (end != PhaseEnd::reached) return end;
        join_seams();
    }
    if (progress_.stage == RunStage::press) {
        const PhaseEnd end = timed(RunStage::press, run_pressing());
        if (end != PhaseEnd::reached) return end;
        progress_.stage = RunStage::drape;
        if (settings_.output.frames) recorder_->write_frame(*phase_, {}, elapsed(), true);
        save();
    }
    return timed(RunStage::drape, run_draping());
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

RunOutcome DrapeRun::conclude(RunStatus status, std::string message)
{
    const TraceScope scope("conclude");
    phase_->system().refresh_pairs();
    const double residual = phase_->system().residual(), time = phase_->system().clock().time;
    const StepEvent event{time, 0, 0, 0, residual};
    // A garment that is still being pressed is not yet the draped one that run.h5 begins with.
    if (progress_.stage != RunStage::press) recorder_->write_frame(*phase_, event, elapsed(), true);
    save();
    recorder_->close_phase();
    const double bodies_time = progress_.stage == RunStage::sew ? 0 : time;  // they wait for the garment
    bool complete = status == RunStatus::converged || status == RunStatus::finished;
    if (!recorder_->show_last(bodies_time, *phase_) && complete) {
        complete = false;
        status = RunStatus::interrupted;
        message = "interrupted while the picture was drawn: the state is saved, --resume draws it";
    }
    recorder_->conclude(status, bodies_time, *phase_, plan_, query_ ? &*query_ : nullptr, progress_.counters,
                        stability_, coarse_stages_, profile_, residual, elapsed(), message);
    if (complete && !settings_.output.keep_checkpoint) folder_.remove("checkpoint.h5");
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
                    fmt::format("stopped after {:.3g} s (solver.max_wall); --resume goes on", settings_.max_wall));
}

std::string DrapeRun::why_not_done() const
{
    if (progress_.stage == RunStage::drape)
        return fmt::format("not at rest after {:.1f} s (solver.max_time): relative force residual {:.2e}, asked {:.2e}",
                           phase_->system().clock().time, progress_.draping.residual, settings_.drape.tolerance);
    const Cloth& cloth = model_.cloth_model.cloth;
    const std::vector<double> gaps = measure_seams(cloth, phase_->positions());
    const auto worst = std::max_element(gaps.begin(), gaps.end());
    const Seam& seam = cloth.seams[std::size_t(worst - gaps.begin())];
    const auto side = [&](int index) {
        const OutlineSamples& edge = cloth.outline[index];
        return cloth.panels[edge.panel].name + "[" + std::to_string(edge.edge) + "]";
    };
    return fmt::format("the seam of {} and {} is still open by {:.1f} mm after {:.1f} s (seams.max_time)",
                       side(seam.side_a), side(seam.side_b), 1000 * *worst, settings_.cloth.sew.max_time);
}

RunOutcome DrapeRun::execute()
{
    options_.resume ? resume() : begin();
    try {
        const PhaseEnd end = run_phases();
        if (end == PhaseEnd::stopped) return conclude_stopped();
        if (end == PhaseEnd::time_limit) return conclude(RunStatus::time_limit, why_not_done());
        const bool timed = !settings_.until.equilibrium;
        return timed ? conclude(RunStatus::finished, "") : conclude_at_rest();
    } catch (const UnstableStepError& error) {
        throw InputError(settings_.step_place, fmt::format("{:.6g} s", settings_.drape.step.longest),
                         fmt::format("at most the stability limit of {}, {:.3g} s at {:.3g} s of simulated time, as "
                                     "solver.unstable_step is refuse",
                                     word_of(settings_.integrator), error.limit, phase_->system().clock().time));
    } catch (const DivergenceError& error) {
        return conclude(RunStatus::diverged, std::string("diverged: ") + error.what());
    }
}

namespace {

// What a run that cannot write any more leaves behind, for the message.
std::string what_is_left(RunFolder& folder)
try {
    if (std::filesystem::exists(folder.path() + "/checkpoint.h5"))
        return "; the frames so far and the last checkpoint are kept: --resume goes on from there";
    const bool began = std::filesystem::exists(folder.path() + "/run.h5");
    return began ? "; the frames so far are kept; there is no checkpoint yet to go on from" : "";
} catch (const WriteError&) {
    return "; the run cannot go on without it";
}

}  // namespace

RunOutcome run_drape(const Scene& scene, const RunOptions& options)
{
    std::optional<tbb::global_control> limit;
    if (scene.solver.threads > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(scene.solver.threads));
    std::optional<Trace> trace;
    if (options.profile) trace.emplace();
    const TraceUse use(trace ? &*trace : nullptr);
    RunFolder folder(options.folder);
    if (!folder.not_locked().empty()) fmt::print(stderr, "selvage: {}\n", folder.not_locked());
    try {
        RunOutcome outcome = DrapeRun(scene, options, folder).execute();
        if (trace) conclude_profile(*trace, folder.path());
        outcome.folder = folder.path();
        return outcome;
    } catch (WriteError& error) {
        error.add(what_is_left(folder));
        throw;
    }
}

}  // namespace selvage
