#pragma once
#include "host/scene/scene_model.hpp"
#include "host/solver/terms/params.hpp"

namespace selvage {

/// The parameters of every term and rule in one phase of a scene; a strength of zero leaves a term out.
/// @param sewing  true: while seams are pulled closed, without gravity and friction, panels stiffened
Params phase_params(const Scene& scene, const SceneModel& model, bool sewing);

}  // namespace selvage
