#pragma once
#include <vector>

#include "host/model/cloth_model.hpp"
#include "io/finding.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// Looks for garments and sheets of an odd size, for those that will fall past all bodies, and for cloth so far out
/// that single precision cannot tell its vertices apart.
std::vector<Finding> examine_place(const ClothModel& model, const Scene& scene);

}  // namespace selvage
