#pragma once
#include <string>
#include <vector>

#include "host/examine/file_mesh.hpp"
#include "host/examine/mesh_edges.hpp"
#include "io/errors.hpp"

namespace selvage {

/// Which vertices of a mesh file are joined though the file has them apart.
struct WeldRule {
    bool seams = false;   ///< Rims that lie on each other where texture coordinates say that they were cut apart.
    bool any = false;     ///< All within `distance`.
    double distance = 0;  ///< [m]; 0: exactly on each other.
};

/// Reads `sheet.weld` or `body.weld`: "seams" (sheets only), "none", "exact", or a distance in metres.
/// @throws InputError for anything else
WeldRule weld_rule(const std::string& text, bool for_sheet, const InputPlace& place);

/// Joins the vertices of a mesh that lie at most `distance` [m] from each other, also by way of others.
/// @param place  of the key, for messages
/// @param sets   over the vertices
/// @throws InputError if a face would lose its area, as where two of its corners are joined
void join_near(const FileMesh& mesh, double distance, const InputPlace& place, JoinedSets& sets);

}  // namespace selvage
