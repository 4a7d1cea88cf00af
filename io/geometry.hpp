#pragma once
#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace selvage {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;
using Face = std::array<int, 3>;  ///< Vertex indices, counter-clockwise seen from outside.

/// A named run of consecutive faces, such as a body's left arm.
struct MeshPart {
    std::string name;
    int first_face = 0;
    int face_count = 0;
};

/// A triangle mesh in metres, z up unless its reader was given another axis.
struct TriangleMesh {
    std::vector<Vec3> vertices;  ///< Positions [m].
    std::vector<Face> faces;
    std::vector<MeshPart> parts;  ///< Covers all faces in order, or is empty.
};

}  // namespace selvage
