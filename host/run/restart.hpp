#pragma once
#include <map>
#include <string>
#include <vector>

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

/// What a checkpoint must have in common with the run that goes on from it.
struct RunIdentity {
    std::map<std::string, std::string> scene;  ///< See scene_values.
    std::string meshes;                        ///< Hash of the meshes of cloth and bodies that came of it.
    /// Vertices of the cloth that the shape of each coarse stage is carried over to, in the order of the stages.
    std::vector<std::size_t> carried_to;
    int faces = 0;               ///< Of the cloth.
    std::size_t seam_pairs = 0;  ///< Of the cloth.
};

RunIdentity identity_of(const RunSettings& settings, const SceneModel& model);

/// Writes a checkpoint: progress, all of the phase that its next step depends on, and which run it is.
void save_run(const std::string& path, const RunIdentity& identity, const RunProgress& progress, const Phase& phase,
              Integrator& integrator);

/// Reads what save_run wrote, except for the phase; see load_phase.
/// @throws InputError if the checkpoint is damaged, or of another scene but for what may change
RunProgress load_progress(const Checkpoint& checkpoint, const std::string& path, const RunIdentity& identity);

}  // namespace selvage
