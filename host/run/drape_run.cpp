#include "host/run/drape_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "host/run/ended_run.hpp"
#include "host/run/failure_report.hpp"
#include "host/run/interrupt.hpp"
#include "host/run/measure.hpp"
#include "host/run/phase_memory.hpp"
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
    identity_ = identity_of(settings_, model_);
    if (meets_bodies(settings_.cloth.draping.params))
        query_.emplace(model_.cloth_model.bodies, cloth_reach(model_.cloth_model.cloth));
}

// Seams that would not close are left to pull.
bool DrapeRun::seams_are_open() const
{
    return progress_.stage != RunStage::coarse && !all_welded(progress_.sewing.welded);
}

double DrapeRun::elapsed() const
{
    return wall_before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
}

namespace {

// How a garment is draped whose seams have not all closed: those still pull.
PhaseOptions with_open_seams(const ClothSettings& settings, const std::vector<char>& welded)
{
    PhaseOptions options = settings.draping;
    options.joined = false;
    options.welded = welded;
    options.params.seam = settings.sewing.params.seam;
    return options;
}

}  // namespace

void DrapeRun::start_phase(RunStage stage, const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities)
{
    const TraceScope scope("start_phase");
    integrator_.reset();
    phase_.reset();  // two phases at once would double the memory
    sewing_.reset();
    if (stage == RunStage::sew) {
        const auto renew = [this] { integrator_ = make_integrator(word_of(settings_.integrator), *phase_); };
        sewing_.emplace(model_, settings_.cloth, progress_.sewing, profile_, phase_, renew,
                        [this] { return must_stop(); });
        sewing_->start();
        return;
    }
    PhaseOptions options =
        seams_are_open() ? with_open_seams(settings_.cloth, progress_.sewing.welded) : settings_.cloth.draping;
    if (!progress_.sewing.welded.empty() && options.local_stiffness)
        bear_pull(options.params, pull_limit(settings_.cloth.sew, progress_.sewing), settings_.cloth.sew.edge_length);
    phase_ = std::make_unique<Phase>(model_.cloth_model, options, meets_bodies(options.params) ? &*query_ : nullptr,
                                     profile_, positions, velocities);
    integrator_ = make_integrator(word_of(settings_.integrator), *phase_);
}

void DrapeRun::begin()
{
    recorder_ = std::make_unique<RunRecorder>(settings_, model_, folder_, options_.quiet, false);
    if (!options_.notice.empty()) recorder_->warn(options_.notice);
    progress_.counters.phases["assemble"] = elapsed();
    recorder_->warn(model_.findings);
    start_afresh(plan_.coarse_start ? RunStage::coarse : plan_.phases.front().stage);
}

// Starts from the scene's own places. While coarser cloths are draped, the run's own waits for its shape.
void DrapeRun::start_afresh(RunStage stage)
{
    start_phase(stage, model_.cloth_model.cloth.positions, {});
    // A garment that is being sewn is shown as panels.
    const bool sews = stage == RunStage::sew;
    recorder_->open_phase(stage, sews ? make_topology(model_.cloth_model.cloth, false) : phase_->topology(), -1);
    progress_.stage = stage;
    // Panels that have been joined unsewn are no sight.
    const bool shows = stage != RunStage::coarse || !model_.sews;
    if (settings_.output.frames && shows) recorder_->write_frame(*phase_, {}, elapsed(), true);
}

// Nothing in the folder is touched before the checkpoint has turned out to be the right one. Returns false if there is
// nothing left to do.
bool DrapeRun::resume()
{
    const Checkpoint checkpoint = read_checkpoint(checkpoint_path());
    progress_ = load_progress(checkpoint, checkpoint_path(), identity_);
    if (progress_.ended && has_ended(options_.folder)) return false;
    wall_before_ = last_checkpoint_ = progress_.wall_seconds;
    start_phase(progress_.stage, model_.cloth_model.cloth.positions, {});
    load_phase(checkpoint, checkpoint_path(), *phase_, *integrator_);
    recorder_ = std::make_unique<RunRecorder>(settings_, model_, folder_, options_.quiet, true);
    recorder_->warn(model_.findings);
    recorder_->open_phase(progress_.stage, phase_->topology(), progress_.frames);
    recorder_->set_frame_progress(progress_.frame);
    return true;
}

void DrapeRun::save()
{
    const TraceScope scope("checkpoint");
    // In the middle of a coarse stage there is nothing to go on from: it is repeated from its start.
    RunProgress progress = progress_.stage == RunStage::coarse ? repeats_from_ : progress_;
    progress.counters.phases = progress_.counters.phases;
    progress.wall_seconds = elapsed();
    progress.frames = recorder_->frame_count();
    progress.frame = recorder_->frame_progress();
    folder_.write([&](const std::string& folder) {
        save_run(folder + "/checkpoint.h5", identity_, progress, *phase_, *integrator_);
    });
    last_checkpoint_ = elapsed();
    stopped_ = options_.after_checkpoint && !options_.after_checkpoint();
}

// An attempt that is broken off is repeated when the run is resumed: it then counts once.
void DrapeRun::hear_attempt(bool undone)
{
    if (progress_.stage == RunStage::coarse) return;  // its stage is repeated
    if (undone) {
        progress_.counters = repeats_from_.counters;
        recorder_->set_frame_progress(repeats_from_.frame);
        return;
    }
    repeats_from_.counters = progress_.counters;
    repeats_from_.frame = recorder_->frame_progress();
}

void DrapeRun::note_stability(const StepEvent& event)
{
    if (std::isinf(event.stable_step)) return;
    StabilityUse& use = progress_.stability;
    const bool first = std::isnan(use.limit);
    use.asked = settings_.drape.step.longest;
    use.limit = first ? event.stable_step : std::min(use.limit, event.stable_step);
    use.taken = first ? event.shortest : std::min(use.taken, event.shortest);
    if (first && event.shortest < settings_.drape.step.longest)
        recorder_->say(fmt::format(
            "solver.step is {:.3g} s, the stability limit of {} here {:.3g} s: taking steps of {:.3g} s",
            settings_.drape.step.longest, word_of(settings_.integrator), event.stable_step, event.shortest));
}

void DrapeRun::note_stretch(const StepEvent& event)
{
    if (progress_.stage != RunStage::drape || event.dt == 0) return;
    FaceStretch& largest = progress_.counters.largest;
    FaceStretch now = largest_stretch(model_.cloth_model.cloth, *phase_, largest.stretch);
    if (now.face < 0) return;
    now.time = event.time;
    largest = now;
}

void DrapeRun::note_accuracy(const StepEvent& event)
{
    MotionAccuracy& accuracy = progress_.counters.accuracy;
    if (event.left >= 0) {
        ++accuracy.steps;
        accuracy.unsolved += !event.solved;
        accuracy.sum_left += event.left;
        if (event.left > accuracy.largest_left) {
            accuracy.largest_left = event.left;
            accuracy.left_time = event.time;
        }
    }
    if (event.error < 0 || progress_.stage != RunStage::drape || settings_.until.equilibrium) return;
    ++accuracy.estimates;
    accuracy.sum_error += event.error;
    if (event.error > accuracy.largest_error) {
        accuracy.largest_error = event.error;
        accuracy.error_time = event.time;
    }
}

bool DrapeRun::after_step(const StepEvent& event)
{
    note_stability(event);
    note_accuracy(event);
    note_stretch(event);
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
    // In the middle of a static attempt there is nothing to go on from either.
    const bool may_go_on_here = event.dt > 0 && progress_.stage != RunStage::coarse;
    if (may_go_on_here && elapsed() - last_checkpoint_ >= settings_.output.checkpoint_interval) save();
    return !must_stop();
}

bool DrapeRun::must_stop() const
{
    const bool out_of_time = settings_.max_wall > 0 && elapsed() - wall_before_ > settings_.max_wall;
    return interrupt_requested() || stopped_ || out_of_time;
}

PhaseEnd DrapeRun::run_sewing()
{
    const TraceScope scope("sew");
    return sewing_->run([this](const StepEvent& event) { return after_step(event); });
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

EquilibriumOptions DrapeRun::draping_options()
{
    EquilibriumOptions options = settings_.drape;
    options.integrator = integrator_.get();
    options.stop = [this] { return must_stop(); };
    options.attempt = [this](bool undone) { hear_attempt(undone); };
    return options;
}

PhaseEnd DrapeRun::run_coarse()
{
    const TraceScope scope("coarse");
    CoarseStart& start = progress_.coarse;
    repeats_from_ = progress_;
    Clock clock = phase_->system().clock();
    const auto after_stage = [&] {
        phase_->system().clock() = clock;
        repeats_from_ = progress_;
        save();
    };
    if (!drape_coarse_first(
            settings_, model_, draping_options(), clock, progress_.draping, profile_,
            [this](const StepEvent& event) { return after_step(event); }, start, after_stage))
        return PhaseEnd::stopped;
    progress_.stage = RunStage::drape;
    if (!start.positions.empty()) {
        phase_->start_over(model_.cloth_model, std::exchange(start.positions, {}));
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
    // A run that is resumed goes on from here, and without the frame that this one ends with.
    save();
    phase_->system().refresh_pairs();
    const double residual = phase_->system().residual(), time = phase_->system().clock().time;
    const StepEvent event{time, 0, 0, 0, residual};
    // A garment that is still being pressed is not yet the draped one that run.h5 begins with.
    if (progress_.stage != RunStage::press) recorder_->write_frame(*phase_, event, elapsed(), true);
    recorder_->close_phase();
    const LastState last =
        recorder_->last_state(sewing_ ? sewing_->bodies() : model_.cloth_model.bodies, time, *phase_);
    bool complete = is_complete(status);
    if (!recorder_->show_last(last, phase_->topology()) && complete) {
        complete = false;
        status = RunStatus::interrupted;
        message = "interrupted while the picture was drawn: the state is saved, --resume draws it";
    }
    const std::vector<Finding> at_end =
        recorder_->conclude(status, last, *phase_, plan_, query_ && !sewing_ ? &*query_ : nullptr, progress_.counters,
                            progress_.stability, progress_.coarse.stages, profile_, residual, elapsed(), message);
    if (complete && !settings_.output.keep_checkpoint) folder_.remove("checkpoint.h5");
    int code = complete ? 0 : 4;
    if (status == RunStatus::diverged) code = 3;
    if (status == RunStatus::interrupted) code = interrupt_exit_code();
    std::string told = message;
    const bool ended_well = complete || status == RunStatus::interrupted;
    for (const Finding& finding : findings_that_mattered(model_.findings, ended_well, at_end))
        told += (told.empty() ? "" : "\n") + ("warned of at the start: " + describe(finding));
    return {status, code, told};
}

RunOutcome DrapeRun::conclude_stopped()
{
    if (interrupt_requested())
        return conclude(RunStatus::interrupted, "interrupted: the state is saved, --resume goes on from here");
    return conclude(RunStatus::time_limit,
                    fmt::format("stopped after {:.3g} s (solver.max_wall) at {:.4g} s of simulated time ({}): relative "
                                "force residual {:.2e}; --resume goes on",
                                settings_.max_wall, phase_->system().clock().time, text_of(progress_.stage),
                                phase_->system().residual()));
}

std::string DrapeRun::open_seam_text() const
{
    return describe(explain(open_seam_facts(model_, *phase_, progress_.sewing.grows_from)));
}

std::string DrapeRun::why_not_done() const
{
    const std::string unrest =
        describe(explain(unrest_facts(model_, *phase_, progress_.draping.residual, settings_.drape.tolerance)));
    return seams_are_open() ? open_seam_text() + "\n" + unrest : unrest;
}

RunOutcome DrapeRun::execute()
{
    if (!options_.resume)
        begin();
    else if (!resume())
        return nothing_left(options_.folder);
    try {
        const PhaseEnd end = progress_.ended ? PhaseEnd::reached : run_phases();
        progress_.ended = end == PhaseEnd::reached;
        if (end == PhaseEnd::stopped) return conclude_stopped();
        if (end == PhaseEnd::time_limit) return conclude(RunStatus::time_limit, why_not_done());
        if (seams_are_open()) return conclude(RunStatus::time_limit, open_seam_text());
        const bool timed = !settings_.until.equilibrium;
        return timed ? conclude(RunStatus::finished, "") : conclude_at_rest();
    } catch (const UnstableStepError& error) {
        throw InputError(settings_.step_place, fmt::format("{:.6g} s", settings_.drape.step.longest),
                         fmt::format("at most the stability limit of {}, {:.3g} s at {:.3g} s of simulated time, as "
                                     "solver.unstable_step is refuse",
                                     word_of(settings_.integrator), error.limit, phase_->system().clock().time));
    } catch (const StepFailureError& error) {
        const std::string message = describe(
            explain(divergence_facts(model_, *phase_, text_of(progress_.stage), error.failure, integrator_->info())));
        return conclude(RunStatus::diverged, message);
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
    const bool ended = options.resume && !has_checkpoint(options.folder) && is_done(scene, options.folder);
    if (ended) return nothing_left(options.folder);  // without a hold on the folder, which may be read-only by now
    std::optional<tbb::global_control> limit;
    if (scene.solver.threads > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(scene.solver.threads));
    std::optional<Trace> trace;
    if (options.profile) trace.emplace();
    const TraceUse use(trace ? &*trace : nullptr);
    RunFolder folder(options.folder);
    if (!folder.not_locked().empty()) fmt::print(stderr, "selvage: {}\n", folder.not_locked());
    RunOptions used = options;
    if (options.resume && !has_checkpoint(options.folder)) {
        used.resume = false;
        const bool replaces = std::filesystem::exists(folder.path() + "/run.h5");
        used.notice = "no checkpoint in " + options.folder + " to go on from: the run starts from the beginning" +
                      (replaces ? " and replaces the results that are there" : "");
    }
    try {
        RunOutcome outcome = DrapeRun(scene, used, folder).execute();
        if (trace) conclude_profile(*trace, folder.path());
        outcome.folder = folder.path();
        return outcome;
    } catch (WriteError& error) {
        error.add(what_is_left(folder));
        throw;
    }
}

}  // namespace selvage
