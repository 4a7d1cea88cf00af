#include "host/drape_run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "host/interrupt.hpp"
#include "host/measure.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

// Checkpoints hold particle fields by name; the scene itself is rebuilt from its text.
constexpr const char* restart_mismatch = "the checkpoint of another scene";

PhaseOptions phase_options(const Scene& scene, const SceneModel& model, const PhasePlan& plan)
{
    PhaseOptions options;
    options.params = plan.params;
    options.joined = plan.joined;
    options.float_solves = scene.solver.precision == "float";
    options.linear.max_iterations = scene.solver.linear_iterations;
    const bool levels = !model.model.coarser.empty() && scene.solver.preconditioner != "block_jacobi";
    options.linear.preconditioner = levels ? Preconditioner::multigrid : Preconditioner::block_jacobi;
    return options;
}

}  // namespace

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
    const auto plan = std::find_if(plan_.phases.begin(), plan_.phases.end(),
                                   [&](const PhasePlan& phase) { return phase.name == name; });
    phase_name_ = name;
    phase_.reset();   // two phases at once would double the memory
    phase_ = std::make_unique<Phase>(model_.model, phase_options(scene_, model_, *plan),
                                     plan->queries_bodies ? &*query_ : nullptr, profile_, positions, velocities);
}

void DrapeRun::save()
{
    const State& state = phase_->state();
    Checkpoint checkpoint;
    checkpoint.words = {{"scene_text", scene_.text}, {"phase", phase_name_}};
    checkpoint.integers["counts"] = {counters_.steps, counters_.newton_iterations, counters_.linear_iterations,
                                     recorder_->frame_count(), sewing_.steps_without_gain, draping_.hold};
    checkpoint.reals["clock"] = {counters_.simulated, elapsed(), sewing_.time, sewing_.best_gap, sewing_.elastic_energy,
                                 draping_.time, draping_.switch_residual, phase_->params().seam.stiffness,
                                 phase_->params().seam.force_limit};
    checkpoint.reals["pos"] = state.pos;
    checkpoint.reals["vel"] = state.vel;
    checkpoint.reals["friction_anchor"] = state.friction_anchor;
    checkpoint.reals["friction_limit"] = state.friction_limit;
    for (const auto& [name, seconds] : counters_.phases) checkpoint.reals["phase_" + name] = {seconds};
    write_checkpoint(recorder_->checkpoint_path(), checkpoint);
    last_checkpoint_ = elapsed();
}

void DrapeRun::restore()
{
    const std::string path = recorder_->checkpoint_path();
    const Checkpoint checkpoint = read_checkpoint(path);
    if (checkpoint.words.at("scene_text") != scene_.text)
        throw InputError({path, 0, 0, "scene_text"}, restart_mismatch, "one left by this very scene; run without --resume");
    start_phase(checkpoint.words.at("phase"), model_.model.cloth.positions, {});
    State& state = phase_->state();
    const std::vector<int>& counts = checkpoint.integers.at("counts");
    const std::vector<double>& clock = checkpoint.reals.at("clock");
    if (checkpoint.reals.at("pos").size() != state.pos.size())
        throw InputError({path, 0, 0, "pos"}, restart_mismatch, fmt::format("{} numbers", state.pos.size()));
    counters_.steps = counts[0];
    counters_.newton_iterations = counts[1];
    counters_.linear_iterations = counts[2];
    sewing_ = {clock[2], clock[3], counts[4], clock[4]};
    draping_ = {clock[5], clock[6], counts[5]};
    counters_.simulated = clock[0];
    wall_before_ = clock[1];
    phase_->params().seam.stiffness = clock[7];
    phase_->params().seam.force_limit = clock[8];
    state.pos = checkpoint.reals.at("pos");
    state.vel = checkpoint.reals.at("vel");
    state.friction_anchor = checkpoint.reals.at("friction_anchor");
    state.friction_limit = checkpoint.reals.at("friction_limit");
    for (const auto& [name, values] : checkpoint.reals)
        if (name.starts_with("phase_")) counters_.phases[name.substr(6)] = values.front();
    recorder_->open_phase(phase_name_, phase_->topology(), counts[3]);
}

bool DrapeRun::after_step(const StepEvent& event)
{
    ++counters_.steps;
    counters_.newton_iterations += event.newton_iterations;
    counters_.linear_iterations += event.linear_iterations;
    counters_.simulated += event.dt;
    recorder_->report(phase_name_, event, counters_.steps);
    recorder_->write_frame(*phase_, event, elapsed(), false);
    if (elapsed() - last_checkpoint_ >= scene_.output.checkpoint_interval) save();
    wall_limit_hit_ = scene_.solver.max_wall > 0 && elapsed() > scene_.solver.max_wall;
    return !interrupt_requested() && !wall_limit_hit_;
}

PhaseEnd DrapeRun::run_sewing()
{
    SewingOptions options;
    options.step = scene_.solver.step;
    options.closed = scene_.seams.closed;
    options.energy_tolerance = scene_.solver.energy_tolerance;
    options.max_time = scene_.seams.max_time;
    return sew(*phase_, options, sewing_, [this](const StepEvent& event) { return after_step(event); });
}

void DrapeRun::join_seams()
{
    recorder_->close_phase();
    const std::vector<Vec3> positions = phase_->positions(), velocities = phase_->velocities();
    start_phase("drape", positions, velocities);
    recorder_->open_phase(phase_name_, phase_->topology(), -1);
}

PhaseEnd DrapeRun::run_pressing()
{
    return press_seams(*phase_, scene_.solver.step, [this](const StepEvent& event) {
        ++counters_.steps;
        counters_.newton_iterations += event.newton_iterations;
        counters_.linear_iterations += event.linear_iterations;
        counters_.simulated += event.dt;
        recorder_->report("press", event, counters_.steps);
        return !interrupt_requested();
    });
}

PhaseEnd DrapeRun::run_drape_phase()
{
    EquilibriumOptions options;
    options.step = scene_.solver.step;
    options.tolerance = scene_.solver.tolerance;
    options.max_time = scene_.solver.max_time;
    options.newton_iterations = scene_.solver.newton_iterations;
    options.statics_only = scene_.solver.integrator == "static";
    const AfterStep hear = [this](const StepEvent& event) { return after_step(event); };
    if (scene_.solver.until == "equilibrium") return drape_to_equilibrium(*phase_, options, draping_, hear);
    return drape_until(*phase_, options, std::stod(scene_.solver.until), 1 / scene_.solver.frame_rate, draping_, hear);
}

RunOutcome DrapeRun::conclude(RunStatus status, const std::string& message)
{
    const double residual = phase_->newton().static_residual();
    const StepEvent event{phase_name_ == "sew" ? sewing_.time : draping_.time, 0, 0, 0, residual};
    recorder_->write_frame(*phase_, event, elapsed(), true);
    const bool complete = status == RunStatus::converged || status == RunStatus::finished;
    if (complete && !scene_.output.keep_checkpoint)
        std::filesystem::remove(recorder_->checkpoint_path());
    else
        save();
    recorder_->close_phase();
    recorder_->conclude(status, *phase_, plan_, query_ ? &*query_ : nullptr, counters_, profile_, residual, elapsed(),
                        message);
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
                    fmt::format("stopped after {:.0f} s (solver.max_wall); --resume goes on", scene_.solver.max_wall));
}

RunOutcome DrapeRun::conclude_unsewn()
{
    const Cloth& cloth = model_.model.cloth;
    const std::vector<double> gaps = measure_seams(cloth, phase_->positions());
    const auto worst = std::max_element(gaps.begin(), gaps.end());
    const Seam& seam = cloth.seams[std::size_t(worst - gaps.begin())];
    const auto side = [&](int index) {
        const OutlineSamples& edge = cloth.outline[index];
        return cloth.panels[edge.panel].name + "[" + std::to_string(edge.edge) + "]";
    };
    return conclude(RunStatus::time_limit,
                    fmt::format("the seam of {} and {} is still open by {:.1f} mm after {:.1f} s (seams.max_time)",
                                side(seam.side_a), side(seam.side_b), 1000 * *worst, scene_.seams.max_time));
}

RunOutcome DrapeRun::conclude_draped(PhaseEnd end)
{
    if (end == PhaseEnd::stopped) return conclude_stopped();
    const bool timed = scene_.solver.until != "equilibrium";
    if (end == PhaseEnd::reached) return conclude(timed ? RunStatus::finished : RunStatus::converged, "");
    return conclude(RunStatus::time_limit,
                    fmt::format("not at rest after {:.1f} s (solver.max_time): relative force residual {:.2e}, asked {:.2e}",
                                draping_.time, phase_->newton().static_residual(), scene_.solver.tolerance));
}

RunOutcome DrapeRun::execute()
{
    recorder_ = std::make_unique<RunRecorder>(scene_, model_, options_, options_.resume);
    counters_.phases["assemble"] = elapsed();
    if (options_.resume) {
        restore();
    } else {
        start_phase(plan_.phases.front().name, model_.model.cloth.positions, {});
        recorder_->open_phase(phase_name_, phase_->topology(), -1);
    }
    double phase_start = elapsed();
    const auto finish_phase = [&] {
        counters_.phases[phase_name_] += elapsed() - phase_start;
        phase_start = elapsed();
    };
    try {
        if (phase_name_ == "sew") {
            const PhaseEnd end = run_sewing();
            finish_phase();
            if (end == PhaseEnd::stopped) return conclude_stopped();
            if (end == PhaseEnd::time_limit) return conclude_unsewn();
            join_seams();
            const PhaseEnd pressed = run_pressing();
            finish_phase();
            if (pressed == PhaseEnd::stopped) return conclude_stopped();
            save();
        }
        const PhaseEnd end = run_drape_phase();
        finish_phase();
        return conclude_draped(end);
    } catch (const DivergenceError& error) {
        finish_phase();
        return conclude(RunStatus::diverged, std::string("diverged: ") + error.what());
    }
}

RunOutcome run_drape(const Scene& scene, const RunOptions& options)
{
    std::optional<tbb::global_control> limit;
    if (scene.solver.threads > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(scene.solver.threads));
    return DrapeRun(scene, options).execute();
}

}  // namespace selvage
