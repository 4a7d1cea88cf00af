#pragma once
#include <vector>

#include "host/model/cloth_model.hpp"
#include "io/finding.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// Looks for what a scene says that can be run but is hardly meant: gravity in another unit or direction, motions that
/// begin after the end, distances of contact beyond the length of edges, a run shorter than a step, lists without
/// elements, bodies that stand twice or within others, and fabrics that are none (see examine_fabric).
/// @param edge_length  typical of the finest cloth [m]
std::vector<Finding> examine_scene(const Scene& scene, const ClothModel& model, double edge_length);

}  // namespace selvage
