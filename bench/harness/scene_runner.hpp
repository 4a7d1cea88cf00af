#pragma once
#include <optional>
#include <string>
#include <vector>

#include "host/collision/body_query.hpp"
#include "host/scene/plan.hpp"
#include "host/scene/scene_model.hpp"
#include "host/solver/stepping/equilibrium.hpp"

namespace selvage {

/// The settings in which the runs of one scene differ.
struct RunSetting {
    std::string integrator = "implicit_euler";
    double step = 0.02;            ///< [s]
    double tolerance = 1e-2;       ///< Of the equilibrium [1].
    double step_tolerance = 1e-2;  ///< Acceleration that a step of a motion may leave to find, over gravity [1].
    double step_error = 0;         ///< Adaptive steps err by so much each [m]; 0: steps are fixed.
    bool float_solves = false;
    bool refuse_unstable = true;  ///< Explicit steps above the stability limit end the run.
};

/// What came of it.
struct RunResult {
    std::vector<Vec3> positions;  ///< At the end, per cloth vertex [m].
    double wall = 0;              ///< Of the steps alone, without meshing and allocation [s].
    double cpu = 0;               ///< Of the same by thread_seconds() [s].
    int steps = 0, newton_iterations = 0, linear_iterations = 0;
    bool finished = false;  ///< Reached the end, or equilibrium.
    std::string message;    ///< Why not.
};

/// What the calling thread has computed so far [s]; unlike time on the wall it does not depend on who else computes.
double thread_seconds();

/// Runs one scene again and again from its start, without files.
class SceneRunner {
public:
    /// @param source     as for read_scene   @param overrides  likewise
    SceneRunner(const std::string& source, const std::vector<std::string>& overrides);

    const Scene& scene() const { return scene_; }
    const SceneModel& model() const { return model_; }
    /// Moves the cloth to the scene's solver.until, or to equilibrium. Never throws for a run that fails.
    RunResult run(const RunSetting& setting);
    /// A phase at the scene's start, for measurements of one's own.
    Phase make_phase(bool float_solves, const std::vector<Vec3>& velocities = {});

private:
    void move(Phase& phase, const RunSetting& setting, RunResult& result) const;

    Scene scene_;
    SceneModel model_;
    PhasePlan plan_;
    std::optional<BodyQuery> query_;
    Profile profile_;
};

/// Root mean square of the distances between two shapes over that of the way from the start to the reference [1].
double position_error(const std::vector<Vec3>& positions, const std::vector<Vec3>& reference,
                      const std::vector<Vec3>& start);

}  // namespace selvage
