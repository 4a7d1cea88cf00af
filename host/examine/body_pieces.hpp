#pragma once
#include <vector>

#include "host/examine/file_mesh.hpp"
#include "host/examine/mesh_edges.hpp"
#include "io/finding.hpp"

namespace selvage {

/// Returns the volume that each piece encloses [m^3]; negative where its faces look inward.
std::vector<double> piece_volumes(const TriangleMesh& mesh, const Pieces& pieces);

/// Requires that the pieces of a closed surface look outward, but for cavities, which lie inside other pieces. If all
/// outer pieces look inward, everything is turned, and that is a finding.
/// @throws InputError for a piece inside out or without volume
void face_outward(FileMesh& body, const Pieces& pieces, std::vector<Finding>& findings);

/// Tells of triangles of a body that intersect.
void find_body_crossings(const FileMesh& body, const Pieces& pieces, std::vector<Finding>& findings);

}  // namespace selvage
