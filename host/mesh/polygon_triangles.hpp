#pragma once
#include <array>
#include <span>
#include <vector>

#include "io/geometry.hpp"
#include "io/mesh/mesh_obj.hpp"

namespace selvage {

/// Splits a polygon into triangles, as indices of its corners. Flat convex polygons become fans from their first
/// corner. Others are clipped ear by ear, the best shaped one first, in the plane that their area is largest in: the
/// triangles are then the same whichever corner the polygon begins with.
/// @param vertices   positions [m]
/// @param polygon    at least 3 vertices, each once
/// @param triangles  gets n - 2 triangles
/// @return false if the polygon has no area or crosses itself; `triangles` is then unchanged
bool split_polygon(const std::vector<Vec3>& vertices, std::span<const int> polygon,
                   std::vector<std::array<int, 3>>& triangles);

/// Returns the triangles of an OBJ file whose faces are known to be good, as of those that this program wrote.
TriangleMesh triangle_mesh(const ObjMesh& obj);

}  // namespace selvage
