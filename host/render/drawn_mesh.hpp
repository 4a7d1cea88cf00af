#pragma once
#include <array>
#include <span>
#include <vector>

#include "io/geometry.hpp"

namespace selvage {

using Vec3f = Eigen::Vector3f;

/// Which faces touch each vertex, in compressed rows.
struct VertexFaces {
    std::vector<int> offset;  ///< Vertex count + 1.
    std::vector<int> face;

    std::span<const int> of(int vertex) const
    {
        const int first = offset[std::size_t(vertex)];
        return {face.data() + first, std::size_t(offset[std::size_t(vertex) + 1] - first)};
    }
};

/// A mesh made ready for drawing: single precision about an origin, with one shading normal per face corner.
struct DrawnMesh {
    std::vector<Vec3f> positions;               ///< Relative to the picture's origin [m].
    std::vector<Face> faces;                    ///< Those that can be drawn.
    std::vector<int> source_face;               ///< Index of each in the mesh it came from.
    std::vector<Vec3f> face_normals;            ///< Unit, right-handed.
    std::vector<std::array<Vec3f, 3>> normals;  ///< Unit, at the corners of each face.
    VertexFaces vertex_faces;

    /// Returns the point of a face with weights (1 - u - v, u, v) on its corners.
    Vec3f point(int face, float u, float v) const;
};

/// Prepares a mesh for drawing. Faces without area or with a corner that is not finite are left out. The normal of a
/// corner is the area-weighted mean over those faces around its vertex whose normals differ from that of its own face
/// by less than the crease angle (60 degrees), so that smooth cloth shades smoothly and sharp folds stay sharp.
/// @throws std::invalid_argument if a face names a vertex that does not exist.
DrawnMesh make_drawn_mesh(std::span<const Vec3> positions, std::span<const Face> faces, const Vec3& origin);

}  // namespace selvage
