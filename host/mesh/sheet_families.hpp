#pragma once
#include <string>
#include <vector>

#include "io/geometry.hpp"

namespace selvage {

/// The triangles of a plain sheet around the origin.
struct SheetMesh {
    std::vector<Vec2> points;  ///< (weft, warp) [m].
    std::vector<Face> faces;   ///< Counter-clockwise.
};

/// The ways in which a rectangle can be cut into triangles.
///     alternating, same_diagonal, rows   squares with one diagonal each; rows: its direction changes from row to row
///     cross                              squares with both diagonals and a vertex where they meet
///     equilateral                        rows of equal triangles, halved at the left and right edge
///     irregular                          Delaunay triangles of points that are jittered off a grid
const std::vector<std::string>& rectangle_families();
/// The ways in which a disc can be: a rim, and inside it points of a lattice (equilateral, square), jittered ones
/// (irregular), or those of the panel mesher (panel).
const std::vector<std::string>& disc_families();

/// @param columns  vertices along the width, >= 2; as many rows as make the triangles as high as they are wide
/// @param family   one of rectangle_families()
SheetMesh rectangle_mesh(const std::string& family, double width, double height, int columns);

/// @param across  vertices across the diameter
/// @param family  one of disc_families()
SheetMesh disc_mesh(const std::string& family, double radius, int across);

}  // namespace selvage
