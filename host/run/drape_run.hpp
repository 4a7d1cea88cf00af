#pragma once
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "host/run/garment_sewing.hpp"
#include "host/run/progressive.hpp"
#include "host/run/restart.hpp"
#include "host/run/run.hpp"
#include "host/run/run_recorder.hpp"
#include "host/scene/plan.hpp"
#include "host/scene/run_settings.hpp"
#include "host/scene/scene_model.hpp"
#include "host/solver/stepping/equilibrium.hpp"
#include "host/solver/stepping/sewing.hpp"

namespace selvage {

/// One run from the assembled scene to its end; owns everything that lives as long as the run.
class DrapeRun {
public:
    /// @param folder  for the results; outlives the run
    DrapeRun(const Scene& scene, const RunOptions& options, RunFolder& folder);
    RunOutcome execute();

private:
    /// @param stage  sew: with panels apart; another: with seams joined
    void start_phase(RunStage stage, const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities);
    void begin();
    void start_afresh(RunStage stage);
    bool resume();
    void save();
    PhaseEnd run_phases();
    PhaseEnd run_sewing();
    void join_seams();
    bool seams_are_open() const;
    std::string open_seam_text() const;
    PhaseEnd run_pressing();
    EquilibriumOptions draping_options();
    PhaseEnd run_coarse();
    PhaseEnd run_draping();
    bool after_step(const StepEvent& event);
    void hear_attempt(bool undone);
    bool must_stop() const;
    void note_stability(const StepEvent& event);
    void note_stretch(const StepEvent& event);
    void note_accuracy(const StepEvent& event);
    double elapsed() const;
    RunOutcome conclude_at_rest();
    RunOutcome conclude(RunStatus status, std::string message);
    RunOutcome conclude_stopped();
    std::string why_not_done() const;

    std::string checkpoint_path() { return folder_.path() + "/checkpoint.h5"; }

    RunOptions options_;
    RunFolder& folder_;
    std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
    SceneModel model_;
    RunPlan plan_;
    RunSettings settings_;
    RunIdentity identity_;
    Profile profile_;
    std::optional<BodyQuery> query_;
    std::unique_ptr<Phase> phase_;
    std::unique_ptr<Integrator> integrator_;  ///< Of the drape; sewing has its own.
    RunProgress progress_;
    std::optional<GarmentSewing> sewing_;  ///< While the garment is sewn.
    RunProgress repeats_from_;    ///< What a run resumed in the middle of a coarse stage or an attempt goes on from.
    double wall_before_ = 0;      ///< Of the runs that this one resumes [s].
    bool stopped_ = false;        ///< By RunOptions::after_checkpoint.
    double last_checkpoint_ = 0;  ///< elapsed() then [s].
    std::unique_ptr<RunRecorder> recorder_;
};

}  // namespace selvage
