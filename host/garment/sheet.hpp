#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host/model/cloth.hpp"
#include "io/scene/scene_tables.hpp"

namespace selvage {

/// Makes a rectangle or disc of plain cloth. Panel coordinates have their origin in the middle of the sheet.
/// A rectangle's vertices are numbered row by row, from -warp to +warp and from -weft to +weft; see sheet_families.hpp.
/// @param sheet  shape `rectangle` or `disc`
/// @param file   scene file for messages
/// @param key    key path of the sheet, such as `sheet[0]`; the panel is named after it where the sheet has no name
/// @throws InputError for a mesh family of another shape
Cloth make_sheet(const SheetScene& sheet, const std::string& file, const std::string& key);

/// A sheet's mesh as read from a file, with every vertex at one place of the rest shape.
struct LoadedSheet {
    std::string file;                         ///< For messages.
    TriangleMesh mesh;                        ///< Start shape [m].
    std::vector<Vec2> rest;                   ///< Rest shape [m], one per vertex; empty: the mesh is its own, and flat.
    std::vector<std::array<int, 2>> joined;   ///< Vertices at one place that are one point of the cloth: at its seams.
    std::vector<std::array<int, 2>> numbers;  ///< As ClothPanel::file_numbers.
    std::vector<int> face_lines;              ///< Line of each face in the file; empty: unknown.
};

/// Makes a sheet from a mesh.
/// @param center  where the middle of its bounding box starts; none: where it is. The sheet turns about its middle.
/// @param file    scene file for messages
/// @throws InputError if the rest shape is missing, overlaps itself at an edge, or has faces without area
Cloth sheet_from_mesh(const LoadedSheet& loaded, const SheetScene& sheet, const std::optional<Vec3>& center,
                      const std::string& file, const std::string& key);

}  // namespace selvage
