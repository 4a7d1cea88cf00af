#pragma once
#include <vector>

#include "host/model/cloth.hpp"
#include "io/finding.hpp"
#include "io/pattern/pattern.hpp"

namespace selvage {

/// Looks at a pattern as it is placed and sewn: its seams (see examine_seams), panels that are sewn to nothing, corners
/// that no edge uses, edges much shorter than those of the mesh, and sizes that look like a slip of unit.
/// @param cloth        of the pattern: its panels, outline and seams first, in the pattern's order
/// @param edge_length  of the mesh [m]
std::vector<Finding> examine_pattern(const Pattern& pattern, const Cloth& cloth, double edge_length);

}  // namespace selvage
