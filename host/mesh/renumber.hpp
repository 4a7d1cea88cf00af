#pragma once
#include <vector>

#include "io/geometry.hpp"

namespace selvage {

/// Returns vertices renumbered along a Hilbert curve and faces sorted by their smallest vertex.
/// @param coordinates  [m], reordered in place
/// @param faces        renumbered and sorted in place, each starting with its smallest vertex
/// @returns the new index of each old vertex
std::vector<int> renumber_for_locality(std::vector<Vec2>& coordinates, std::vector<Face>& faces);

}  // namespace selvage
