#pragma once
#include <string>

#include "host/run/progressive.hpp"
#include "host/run/run_recorder.hpp"
#include "host/scene/run_stage.hpp"
#include "host/solver/stepping/equilibrium.hpp"
#include "host/solver/stepping/sewing.hpp"

namespace selvage {

/// Everything of a run that changes while it runs, beside the particles.
struct RunProgress {
    RunStage stage = RunStage::drape;
    SewingProgress sewing;
    PressProgress pressing;
    DrapeProgress draping;
    RunCounters counters;
    FrameProgress frame;
    StabilityUse stability;
    CoarseStart coarse;
    bool ended = false;       ///< There is nothing left to do but to write the results.
    double wall_seconds = 0;  ///< Of this run and those it resumed [s].
    int frames = 0;           ///< Committed in the phase's trajectory.
};

/// Returns a text that tells scene models apart: cloth, fabrics and bodies, not how the solver is set.
std::string model_fingerprint(const SceneModel& model);

/// Writes a checkpoint: progress, all of the phase that its next step depends on, and which model it is.
void save_run(const std::string& path, const SceneModel& model, const RunProgress& progress, const Phase& phase,
              Integrator& integrator);

/// Reads what save_run wrote, except for the phase; see load_phase.
/// @throws InputError if the file is missing, damaged, or of another model
RunProgress load_progress(const Checkpoint& checkpoint, const std::string& path, const SceneModel& model);

}  // namespace selvage
