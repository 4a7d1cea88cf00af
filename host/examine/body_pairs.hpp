#pragma once
#include <vector>

#include "host/model/body.hpp"
#include "io/finding.hpp"

namespace selvage {

/// Looks for bodies that stand twice in a scene, and for bodies within others, which no cloth can touch.
/// @param places  of the bodies in the scene file
std::vector<Finding> examine_body_pairs(const std::vector<Body>& bodies, const std::vector<InputPlace>& places);

}  // namespace selvage
