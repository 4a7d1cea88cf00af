#pragma once
#include <vector>

#include "host/examine/file_mesh.hpp"
#include "host/examine/mesh_edges.hpp"

namespace selvage {

/// The rim of a hole: its vertices in the order in which a face over the hole would run along them.
struct Hole {
    std::vector<int> rim;
    double length = 0;  ///< [m]
    Vec3 middle = Vec3::Zero();
};

/// Returns the holes of a surface, the one with the longest rim first.
std::vector<Hole> find_holes(const std::vector<Vec3>& vertices, const std::vector<FaceSide>& rim);

/// Closes a hole with triangles over the vertices of its rim: those of the least area, or by ear clipping where the rim
/// has many vertices. @return false if that finds no triangles
bool close_hole(const Hole& hole, FileMesh& body);

}  // namespace selvage
