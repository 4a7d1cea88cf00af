#pragma once
#include <string>
#include <vector>

#include "host/scene/memory_plan.hpp"
#include "host/scene/run_stage.hpp"
#include "host/scene/scene_model.hpp"
#include "host/solver/terms/params.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// A kernel that every evaluation of a phase launches.
struct PlannedLaunch {
    std::string name, items;  ///< Term or stage, and the kind of its items.
    int count = 0;
    std::size_t bytes = 0;  ///< That its fields occupy.
};

struct SkippedFeature {
    std::string name, reason;
};

/// What one phase of a run will do; plain data, made without running anything.
struct PhasePlan {
    RunStage stage = RunStage::drape;  ///< sew or drape.
    Params params;
    bool queries_bodies = false;
    std::vector<PlannedLaunch> launches;
    std::size_t field_bytes = 0;   ///< State arrays.
    std::size_t solver_bytes = 0;  ///< Matrix, vectors and coarser levels.
    std::vector<MemoryPart> memory;
};

struct RunPlan {
    std::vector<PhasePlan> phases;
    std::vector<std::string> integrators;  ///< See drape_integrators.
    std::vector<std::string> active;       ///< Terms and devices in use in any phase.
    std::vector<SkippedFeature> skipped;
    bool embree = false;             ///< A ray tracing device is made, for bodies of meshes or the picture.
    bool coarse_start = false;       ///< Coarser cloths are draped first.
    std::vector<MemoryPart> memory;  ///< When most is needed.
    std::size_t peak_bytes = 0;      ///< The sum of it.
};

/// Decides from the scene which terms run in which phase; what the scene lacks is not allocated and not launched.
RunPlan make_plan(const Scene& scene, const SceneModel& model);

/// Checks the plan against the memory limit of the scene or the machine.
/// @throws InputError naming the resolution's key, the estimate and the limit
void check_memory(const Scene& scene, const RunPlan& plan);

}  // namespace selvage
