#pragma once
#include "host/scene/plan.hpp"
#include "host/solver/stepping/sewing.hpp"

namespace selvage {

/// How a scene asks for one of its phases to be solved.
PhaseOptions phase_options(const Scene& scene, const SceneModel& model, const PhasePlan& plan);

/// How a scene asks for its garment to be sewn.
SewingOptions sewing_options(const Scene& scene, const RunPlan& plan);

/// Precision of the linear solves, "float" or "double": solver.precision, or what this cloth needs.
std::string solve_precision(const Scene& scene, const Cloth& cloth);

/// The integrator that moves the cloth while it drapes: solver.integrator, or what `bench work-precision` finds best:
/// bdf2 for motions without bodies, implicit_euler with them; on the way to rest static where the way does not matter
/// (no bodies and so no friction, no hysteresis), implicit_euler elsewhere.
std::string integrator_of(const Scene& scene);

}  // namespace selvage
