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
    double step = 0.02;       ///< [s]
    double tolerance = 1e-2;  ///< Of the Newton iterations of a step, or of the equilibrium [1].
    double still = 0;         ///< See NewtonOptions [m/s].
    int iterations = 0;  ///< Newton iterations per step, accepted even if unconverged; 0: until the tolerance is met.
    bool float_solves = false;
    bool refuse_unstable = true;  ///< Explicit steps above the stability limit end the run.
};

/// The result of a run.
struct RunResult {
    std::vector<Vec3> positions;  ///< At the end, per cloth vertex [m].
    double wall = 0;              ///< Wall time of the steps alone, without meshing and allocation [s].
    double cpu = 0;               ///< CPU time of the calling thread for the same [s], see thread_seconds().
    int steps = 0, newton_iterations = 0, linear_iterations = 0, retries = 0;
    bool finished = false;  ///< The run reached its end time, or equilibrium.
    std::string message;    ///< The reason if it did not.
};

/// Returns the CPU time of the calling thread so far [s]. Unlike wall time it does not depend on other programs.
double thread_seconds();

/// Runs one scene repeatedly from its start, with different settings and without writing files.
class SceneRunner {
public:
    /// @param source, overrides  as for read_scene
    /// @throws InputError for a scene that cannot be read or built
    SceneRunner(const std::string& source, const std::vector<std::string>& overrides);

    const Scene& scene() const { return scene_; }
    const SceneModel& model() const { return model_; }
    /// Moves the cloth to the scene's solver.until, or to equilibrium. A run that diverges or is refused does not
    /// throw; its result has a message.
    RunResult run(const RunSetting& setting);
    /// Makes a phase at the scene's start, for measurements that run() does not make.
    /// @param velocities  per cloth vertex [m/s]; empty: at rest
    Phase make_phase(bool float_solves, const std::vector<Vec3>& velocities = {});

private:
    void move(Phase& phase, const RunSetting& setting, RunResult& result) const;

    Scene scene_;
    SceneModel model_;
    PhasePlan plan_;
    std::optional<BodyQuery> query_;
    Profile profile_;
};

/// Returns the root mean square distance between two shapes, divided by the root mean square displacement from the
/// start to the reference [1]; infinite if a position is not finite.
double position_error(const std::vector<Vec3>& positions, const std::vector<Vec3>& reference,
                      const std::vector<Vec3>& start);

}  // namespace selvage
