#pragma once
#include <vector>

#include "host/model/body.hpp"
#include "io/finding.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// Returns the bodies of a scene with their motions: reads their meshes and poses, makes mannequins.
/// @param findings  gets what was found in their files
/// @throws InputError for a mesh that is no closed solid, or poses with other faces than the body's own
std::vector<Body> build_bodies(const Scene& scene, std::vector<Finding>& findings);

}  // namespace selvage
