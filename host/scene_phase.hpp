#pragma once
#include "host/solver/plan.hpp"

namespace selvage {

/// How a scene asks for one of its phases to be solved.
PhaseOptions phase_options(const Scene& scene, const SceneModel& model, const PhasePlan& plan);

}  // namespace selvage
