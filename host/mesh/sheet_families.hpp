#pragma once
#include <span>
#include <vector>

#include "io/choices.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// The triangles of a flat rectangle or disc around the origin.
struct SheetMesh {
    std::vector<Vec2> points;  ///< (weft, warp) [m].
    std::vector<Face> faces;   ///< Counter-clockwise.
};

/// The triangulations of a rectangle, the default first.
///     alternating, same_diagonal, rows   squares with one diagonal each; rows: its direction changes from row to row
///     cross                              squares with both diagonals and a vertex where they meet
///     equilateral                        rows of equal triangles, halved at the left and right edge
///     irregular                          Delaunay triangles of points that are jittered off a grid
std::span<const MeshFamily> rectangle_families();
/// The triangulations of a disc, the default first. Its vertices lie on the rim and, inside it, on a lattice
/// (equilateral, square), on a jittered grid (irregular), or where the panel mesher puts them (panel).
std::span<const MeshFamily> disc_families();

/// Returns a rectangle mesh.
/// @param columns  vertices along the width, >= 2; the number of rows makes the triangles about as high as wide
/// @param family   one of rectangle_families()
SheetMesh rectangle_mesh(MeshFamily family, double width, double height, int columns);

/// Returns a disc mesh.
/// @param across  vertices across the diameter
/// @param family  one of disc_families()
SheetMesh disc_mesh(MeshFamily family, double radius, int across);

}  // namespace selvage
