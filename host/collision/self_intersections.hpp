#pragma once
#include <vector>

#include "host/collision/triangle_tree.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// Two triangles that meet, by their indices.
using IntersectingPair = TrianglePair;

/// Finds every pair of a mesh's triangles that intersect, by exact predicates. Pairs that share a corner count if an
/// edge of one that does not end there meets the other; pairs that share an edge, and triangles without area, do not.
/// @param vertices  finite positions [m]
/// @returns pairs with the smaller index first, sorted
std::vector<IntersectingPair> self_intersections(const std::vector<Vec3>& vertices, const std::vector<Face>& faces);

/// Finds every pair of a triangle of one mesh and a triangle of another that intersect, by exact predicates.
std::vector<IntersectingPair> mutual_intersections(const std::vector<Vec3>& vertices, const std::vector<Face>& faces,
                                                   const TriangleMesh& other);

}  // namespace selvage
