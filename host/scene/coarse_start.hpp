#pragma once
#include <cstddef>
#include <string>

#include "host/scene/scene_model.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// How many of the coarser cloths a scene is draped on first, if it is: those above a longest edge for garments.
std::size_t levels_used(const Scene& scene, const SceneModel& model);

/// Says why a scene is not draped from coarse to fine; empty: it is.
/// Only shapes at rest may be reached on another way than the cloth would go, and only where the way leaves no trace.
std::string why_no_coarse_start(const Scene& scene, const SceneModel& model);

}  // namespace selvage
