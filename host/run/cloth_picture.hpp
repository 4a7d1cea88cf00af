#pragma once
#include <string>
#include <vector>

#include "host/render/picture.hpp"
#include "host/solver/stepping/phase.hpp"

namespace selvage {

/// For every cloth vertex, the first one of its particle: sewn vertices have the same one.
std::vector<int> representatives(const Topology& topology);

/// The outward faces of a cloth with one vertex standing for all that are sewn to each other, so that faces of two
/// panels share the vertices of their seam.
std::vector<Face> shared_faces(const Cloth& cloth, const Topology& topology);

/// Draws the cloth and its bodies, seams visible. A picture that options.stop has broken off has no pixels.
/// @param faces  see shared_faces
Image draw_cloth(const Cloth& cloth, const std::vector<TriangleMesh>& bodies, const std::vector<Vec3>& positions,
                 const std::vector<Face>& faces, const Topology& topology, PictureOptions options);

}  // namespace selvage
