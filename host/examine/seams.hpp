#pragma once
#include <vector>

#include "host/model/cloth.hpp"
#include "io/finding.hpp"
#include "io/pattern/pattern.hpp"

namespace selvage {

/// Looks at the seams of a pattern as it is placed: those that cross when sewn, panels that are sewn to their
/// neighbours mirrored, and seams whose sides differ in length or lie far apart.
/// @param cloth  of the pattern: its panels, outline and seams first, in the pattern's order
std::vector<Finding> examine_seams(const Pattern& pattern, const Cloth& cloth);

}  // namespace selvage
