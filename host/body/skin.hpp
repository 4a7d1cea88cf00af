#pragma once
#include <span>
#include <vector>

#include "io/geometry.hpp"

namespace selvage {

/// An edge with a single face.
struct OpenEdge {
    int from = 0, to = 0;  ///< Vertices.
    int face = 0;
};

/// The surface of a body made ready for measuring: vertices that lie on each other are one, and only the piece with the
/// largest area is kept; eyes, lashes and hair that lie loose around it are no part of it.
struct Skin {
    std::vector<Vec3> vertices;  ///< [m]
    std::vector<Vec3> smooth;    ///< The same without noise, for ways over the skin, which noise makes longer [m].
    std::vector<Face> faces;
    std::vector<int> of_given;       ///< Vertex for each one of the mesh that was given; -1: it is no part of the skin.
    std::vector<double> area;        ///< A third of the faces around each vertex [m^2].
    std::vector<int> first_face_of;  ///< Vertex count + 1: where the faces of each vertex begin in `vertex_faces`.
    std::vector<int> vertex_faces;
    std::vector<OpenEdge> rims;  ///< The edges of holes.
    double area_share = 1;       ///< Of the kept piece in the area of all pieces.

    std::span<const int> faces_of(int vertex) const
    {
        const int first = first_face_of[vertex];
        return {vertex_faces.data() + first, std::size_t(first_face_of[vertex + 1] - first)};
    }
};

/// Makes the skin of a mesh. A mesh without any area gives an empty skin.
Skin make_skin(const TriangleMesh& mesh);

}  // namespace selvage
