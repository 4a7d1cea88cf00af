#pragma once
#include <map>
#include <string>

#include "host/model/cloth.hpp"
#include "io/pattern/pattern.hpp"

namespace selvage {

/// Returns where a point of a panel starts in the scene: rolled onto the panel's cylinder, turned and moved [m].
Vec3 place_on_panel(const PatternPanel& panel, const Vec2& point);

/// Meshes all panels of a pattern, samples the two sides of every seam alike and places the panels in the scene.
/// @param edge_length     target edge length of the triangles [m], > 0
/// @param garment_fabric  of panels that neither `panel_fabrics` nor the pattern gives a fabric
/// @param panel_fabrics   panel name to fabric name
/// @param file            name of the pattern file for messages
/// @param max_vertices    refuses patterns that would need more at this edge length
/// @throws InputError for a faulty outline or stitch, an unknown panel name (key `garment.fabrics.NAME`), or an
///         edge length that is too fine or too coarse for the pattern (key `garment.resolution`)
Cloth assemble_garment(const Pattern& pattern, double edge_length, const std::string& garment_fabric,
                       const std::map<std::string, std::string>& panel_fabrics, const std::string& file,
                       double max_vertices = 20e6);

}  // namespace selvage
