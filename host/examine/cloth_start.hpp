#pragma once
#include <vector>

#include "host/model/cloth_model.hpp"
#include "io/finding.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// Looks for cloth that starts inside a body, through it or through itself, that falls past all bodies or lies too far
/// out for single precision, for triangles that bend badly and for sizes that look like a slip of unit.
/// @param model  of the scene, as it starts
std::vector<Finding> examine_start(const ClothModel& model, const Scene& scene);

}  // namespace selvage
