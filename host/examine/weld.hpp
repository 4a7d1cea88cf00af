#pragma once
#include <string>
#include <vector>

#include "host/examine/mesh_edges.hpp"
#include "io/errors.hpp"
#include "io/geometry.hpp"

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

/// Joins the vertices that lie at most `distance` from each other.
/// @param sets  over the vertices
/// @throws InputError if an edge is not longer than `distance`: its face would vanish
void join_near(const std::vector<Vec3>& vertices, const std::vector<Face>& faces, double distance,
               const InputPlace& place, JoinedSets& sets);

}  // namespace selvage
