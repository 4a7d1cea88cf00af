#pragma once
#include <string>

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
    double wall_seconds = 0;  ///< Of this run and those it resumed [s].
    int frames = 0;           ///< Committed in the phase's trajectory.
};

/// Returns a text that tells scene models apart: cloth, fabrics and bodies, not how the solver is set.
std::string model_fingerprint(const SceneModel& model);

/// Writes a checkpoint: progress, the particles of the phase, what the integrator remembers, and which model it is.
void save_run(const std::string& path, const SceneModel& model, const RunProgress& progress, const Phase& phase,
              Integrator& integrator);

/// Reads what save_run wrote, except for the particles.
/// @throws InputError if the file is missing, damaged, or of another model
RunProgress load_progress(const Checkpoint& checkpoint, const std::string& path, const SceneModel& model);

/// Puts the particles of a checkpoint into a phase.
/// @throws InputError if an array is missing or has another size
void load_particles(const Checkpoint& checkpoint, const std::string& path, Phase& phase);

/// Gives an integrator the history of a checkpoint; the history of another scheme is left alone.
/// @throws InputError if an array is missing or has another size
void load_history(const Checkpoint& checkpoint, const std::string& path, Integrator& integrator);

}  // namespace selvage
