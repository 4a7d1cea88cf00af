#pragma once
#include <vector>

#include "host/garment/sheet.hpp"
#include "io/finding.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// Reads the OBJ file of a sheet and examines it: vertices without a face or on others, loose pieces, vertices on
/// edges, size, rest area. Vertices are joined as `sheet.weld` says; where texture coordinates differ at one point, the
/// sheet has a seam there that is closed from the start.
/// @param index     of the sheet in the scene, whose shape is `mesh`
/// @param findings  gets what was found
/// @throws InputError for a file that is no sheet of cloth
LoadedSheet load_sheet(const Scene& scene, int index, std::vector<Finding>& findings);

}  // namespace selvage
