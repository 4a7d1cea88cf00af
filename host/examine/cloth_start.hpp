#pragma once
#include <vector>

#include "host/model/body.hpp"
#include "host/model/cloth_model.hpp"
#include "io/finding.hpp"

namespace selvage {

/// Looks for cloth that starts inside a body, through it or through itself, for triangles that bend badly and for
/// sizes that look like a slip of unit.
/// @param reach  where the cloth may go, for the query of the bodies
std::vector<Finding> examine_start(const ClothModel& model, const Box& reach);

}  // namespace selvage
