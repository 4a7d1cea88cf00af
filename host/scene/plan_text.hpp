#pragma once
#include <string>

#include "io/scene/scene.hpp"

namespace selvage {

/// Returns what a run of the scene would launch and allocate, what it skips and why, as text or JSON ending in a
/// newline. Meshes the scene, runs nothing.
/// @throws InputError as read_scene and build_scene_model
std::string describe_plan(const Scene& scene, bool json);

}  // namespace selvage
