#pragma once
#include <vector>

#include "host/body/skin.hpp"

namespace selvage {

/// A maximum of a function on the skin, and where the part of the skin around it that lies higher meets another one
/// with a higher maximum.
struct Branch {
    int tip = 0;             ///< Vertex of the maximum.
    int saddle = -1;         ///< Vertex where it ends; -1: the highest of all has no end.
    int into = -1;           ///< Tip of the branch that it meets there.
    double persistence = 0;  ///< Value at the tip less that at the saddle; of the highest, less the least value of all.
};

/// Returns the branches of the merge tree of a function, those whose persistence is at least `least`, highest tip
/// first. Source: Carr, Snoeyink and Axen 2003 (join trees by a sweep with union-find).
/// @param values  one for each vertex; vertices whose value is not finite are left out
std::vector<Branch> merge_tree(const Skin& skin, const std::vector<double>& values, double least);

}  // namespace selvage
