#pragma once
#include <vector>

#include "host/mesh/triangle_tree.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// The indices of two triangles that intersect.
using IntersectingPair = TrianglePair;

/// Finds every pair of a mesh's triangles that intersect, by exact predicates. A pair that shares a corner counts only
/// if the edge of one triangle opposite that corner meets the other triangle. Pairs that share an edge and triangles
/// without area do not count.
/// @param vertices  finite positions [m]
/// @returns pairs with the smaller index first, sorted
std::vector<IntersectingPair> self_intersections(const std::vector<Vec3>& vertices, const std::vector<Face>& faces);

/// A mesh whose tree is built once, for repeated intersection tests with other meshes.
class IntersectionTarget {
public:
    explicit IntersectionTarget(TriangleMesh mesh);
    IntersectionTarget(const IntersectionTarget&) = delete;  // its tree refers to its mesh

    /// As mutual_intersections.
    std::vector<IntersectingPair> intersections(const std::vector<Vec3>& vertices,
                                                const std::vector<Face>& faces) const;

private:
    TriangleMesh mesh_;
    TriangleTree tree_;           // of mesh_
    std::vector<char> has_area_;  // per face
};

/// Finds every pair of a triangle of one mesh and a triangle of another that intersect, by exact predicates.
std::vector<IntersectingPair> mutual_intersections(const std::vector<Vec3>& vertices, const std::vector<Face>& faces,
                                                   const TriangleMesh& other);

}  // namespace selvage
