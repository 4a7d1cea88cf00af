#pragma once
#include <vector>

#include "io/geometry.hpp"

namespace selvage {

/// The triangles of one flat panel.
struct PanelMesh {
    std::vector<Vec2> vertices;  ///< [m]; the points of the polygon come first, unchanged and in their order.
    std::vector<Face> faces;     ///< Counter-clockwise.
};

/// Fills a polygon with an irregular mesh of about equal edges, in which no direction is preferred. The polygon's sides
/// are not divided; near sides shorter than `edge_length` the triangles are smaller.
/// @param polygon      counter-clockwise, not crossing itself [m]
/// @param edge_length  target edge length [m], > 0
/// @throws std::invalid_argument if sides of the polygon cross or touch
PanelMesh mesh_panel(const std::vector<Vec2>& polygon, double edge_length);

/// Triangulates the polygon and the given points inside it (Delaunay), adding none.
/// @param points        [m]; the first `polygon_size` are the polygon, as above
/// @throws std::invalid_argument if sides of the polygon cross or touch, or points coincide
std::vector<Face> triangulate_points(const std::vector<Vec2>& points, int polygon_size);

}  // namespace selvage
