#pragma once
#include <array>
#include <string>

#include "io/geometry.hpp"

namespace selvage {

/// The faults of a mesh as a solid body. The index of a first offender is -1 if there is none.
struct BodyMeshReport {
    int zero_area_faces = 0;
    int first_zero_area_face = -1;
    int boundary_edges = 0;  ///< Edges with one face: the rims of holes.
    std::array<int, 2> first_boundary_edge{-1, -1};
    int nonmanifold_edges = 0;  ///< Edges with more than two faces.
    std::array<int, 2> first_nonmanifold_edge{-1, -1};
    int inconsistent_edges = 0;  ///< Edges that both of their faces traverse in the same direction.
    std::array<int, 2> first_inconsistent_edge{-1, -1};
    int doubled_vertices = 0;       ///< Vertices at exactly the position of another.
    double volume = 0;              ///< Signed [m^3]; negative: the faces look inward.
    double extent = 0;              ///< Longest side of the bounding box [m].
    bool size_looks_wrong = false;  ///< The extent is outside 0.05 to 5 m, as if the unit were wrong.
};

/// Examines a mesh as a body.
BodyMeshReport check_body_mesh(const TriangleMesh& mesh);

/// Requires that a mesh is a closed solid of plausible size, whose inside is well defined.
/// @param file  for error messages, which name the line if the file can be opened
/// @throws InputError for zero-area faces, a wrong size, holes, faces that disagree on the outside or look inward.
void require_closed_body(const TriangleMesh& mesh, const std::string& file);

}  // namespace selvage
