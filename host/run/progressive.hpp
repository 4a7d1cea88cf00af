#pragma once
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "host/scene/run_settings.hpp"
#include "host/solver/stepping/equilibrium.hpp"

namespace selvage {

/// What came of one of the coarser cloths.
struct CoarseStage {
    int vertices = 0;
    int newton_iterations = 0, linear_iterations = 0;
    double residual =
        std::numeric_limits<double>::quiet_NaN();  ///< Relative force residual at its end [1]; NaN: it diverged.
    double wall_seconds = 0;
    int intersections = 0;  ///< Of the shape that was carried over from it, with itself and with bodies.
    bool used = true;       ///< False: it diverged, or the finer mesh in its shape intersects too much.
};

/// What came of the coarser cloths so far; kept in checkpoints.
struct CoarseStart {
    std::vector<CoarseStage> stages;  ///< Coarsest first.
    std::vector<Vec3> positions;      ///< Of the next finer cloth [m]; empty if there is no shape to start it from.
};

/// Drapes the coarser cloths of a scene, each from the shape of the one before, and carries the last shape over to the
/// scene's own cloth. A garment is sewn at the coarsest. Most of the way is gone there, where a step costs next to
/// nothing; on bodies only until the forces nearly balance, since the last of the way is another one on the finer mesh.
/// Where cloth must not pass through itself or a body, a carried shape that does is dropped, as is that of a stage that
/// diverged: the finer cloth then starts as the scene says. A garment may start with a few intersections: it is
/// untangled. Source: Zhang and others 2022, progressive cloth quasistatics.
/// @param settings  of the run: they say how many coarser cloths are draped
/// @param options   of the drape of the run itself; every coarser cloth has an integrator of the same kind
/// @param clock     of the run: goes on from stage to stage
/// @param start     what stages have left so far: those are not repeated
/// @param after_stage  called after each stage, whose result stands in `start`: a place to go on from
/// @returns whether the run goes on; false: stopped by after_step, in the middle of a stage that has to be repeated
bool drape_coarse_first(const RunSettings& settings, const SceneModel& model, const EquilibriumOptions& options,
                        Clock& clock, DrapeProgress& progress, Profile& profile, const AfterStep& after_step,
                        CoarseStart& start, const std::function<void()>& after_stage);

/// Interpolates a shape of a coarser cloth, linearly: the fine edges are then as stretched as the coarse ones. A
/// smoother surface would be longer than its chords, and cloth resists that far more than the creases that are left
/// behind (an interpolation exact for quadratic shapes took 12 Newton iterations in place of 7 on a hanging sheet).
/// Held vertices of the fine cloth stay where they are.
/// @param positions  per coarse vertex [m]
std::vector<Vec3> carry_over(const Cloth& fine, const Prolongation& prolongation, const std::vector<Vec3>& positions);

}  // namespace selvage
