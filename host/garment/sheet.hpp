#pragma once
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

/// Makes a sheet from a mesh: its middle (of the bounding box) starts at the sheet's centre.
/// @param mesh                 start shape [m]
/// @param texture_coordinates  rest shape [m], one per vertex; empty: the mesh is flat and its own rest shape
/// @throws InputError if the rest shape is missing, overlaps itself at an edge, or has faces without area
Cloth sheet_from_mesh(const TriangleMesh& mesh, const std::vector<Vec2>& texture_coordinates, const SheetScene& sheet,
                      const std::string& file, const std::string& key);

}  // namespace selvage
