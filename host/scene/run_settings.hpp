#pragma once
#include <map>
#include <string>
#include <vector>

#include "host/scene/scene_model.hpp"
#include "host/solver/stepping/equilibrium.hpp"
#include "host/solver/stepping/sewing.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// How the phases of one cloth are solved: the scene's own cloth, or a coarser one.
struct ClothSettings {
    PhaseOptions sewing;  ///< Only where there are seams to close.
    PhaseOptions draping;
    SewingOptions sew;
};

/// How a run computes and what it writes: the scene, made into settings once. Nothing in it is automatic any more.
struct RunSettings {
    std::string name, file;                     ///< Of the scene.
    std::string text;                           ///< The scene as run.
    std::map<std::string, std::string> values;  ///< All that it says: see scene_values.
    InputPlace step_place;                      ///< Of solver.step, for messages.
    ClothSettings cloth;
    std::vector<ClothSettings> coarser;  ///< Of the coarser cloths that are draped first, finest first.
    IntegratorChoice integrator = IntegratorChoice::implicit_euler;
    PrecisionChoice precision = PrecisionChoice::in_double;
    Until until;
    EquilibriumOptions drape;  ///< Without integrator and `stop`, which belong to the run.
    double max_wall = 0;       ///< Wall time after which the run is saved and ends [s]; 0: no limit.
    double frame_rate = 30;    ///< [1/s]
    OutputScene output;
};

/// Makes the settings of a run.
RunSettings make_run_settings(const Scene& scene, const SceneModel& model);

/// How a phase of a scene is solved. @param sewing  the phase in which seams are closed
PhaseOptions phase_options(const Scene& scene, const SceneModel& model, bool sewing);

/// Precision of the linear solves: solver.precision, or what this cloth needs.
PrecisionChoice solve_precision(const Scene& scene, const ClothModel& model);

/// What steps of a motion may leave to find, over gravity: solver.step_tolerance, or what this cloth affords [1].
double step_tolerance(const Scene& scene, const ClothModel& model);

/// The integrator that moves the cloth while it drapes: solver.integrator, or what `bench work-precision` finds best:
/// bdf2 for motions without bodies, implicit_euler with them; on the way to rest static where the way does not matter
/// (no bodies and so no friction, no hysteresis), implicit_euler elsewhere.
/// A body that moves without coming near the cloth counts as one that stands still.
IntegratorChoice integrator_of(const Scene& scene, const ClothModel& model);

/// The names of those that move the cloth while it drapes, in their order: integrator_of, and the one that takes over
/// on the way to rest, if one does; see RestMode.
std::vector<std::string> drape_integrators(const Scene& scene, const ClothModel& model);

}  // namespace selvage
