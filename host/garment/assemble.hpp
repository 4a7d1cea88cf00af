#pragma once
#include <map>
#include <string>

#include "host/model/cloth.hpp"
#include "io/pattern/pattern.hpp"

namespace selvage {

/// Returns where a bend takes the line x of a panel: across, from the line that stays in place, and towards the inside
/// of the bend [m].
Vec2 place_on_bend(const PanelWrap& wrap, double x);

/// Returns the start position in the scene of a point of a panel: rolled onto the panel's cylinder, rotated
/// and translated [m].
Vec3 place_on_panel(const PatternPanel& panel, const Vec2& point);

/// Meshes all panels of a pattern, with the same number of samples on both sides of every seam, and places them
/// in the scene.
/// @param edge_length     target edge length of the triangles [m], > 0
/// @param garment_fabric  fabric of panels to which neither `panel_fabrics` nor the pattern gives one
/// @param panel_fabrics   panel name to fabric name
/// @param max_vertices    patterns that would need more at this edge length are refused
/// @throws InputError for a faulty outline or stitch, an unknown panel name (key `garment.fabrics.NAME`), or an
///         edge length that is too fine or too coarse for the pattern (key `garment.resolution`)
Cloth assemble_garment(const Pattern& pattern, double edge_length, const std::string& garment_fabric,
                       const std::map<std::string, std::string>& panel_fabrics, double max_vertices = 20e6);

}  // namespace selvage
