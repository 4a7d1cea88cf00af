#pragma once
#include "io/run/trajectory.hpp"

namespace selvage {

/// A unit square of two triangles, each of a panel of its own; the last of its five points belongs to no triangle.
inline TrajectoryLayout square_layout()
{
    TrajectoryLayout layout;
    layout.point_count = 5;
    layout.triangles = {{0, 1, 2}, {1, 3, 2}};
    layout.panel_coordinates = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0.5, 2}};
    layout.panel = {0, 0, 1, 1, 1};
    layout.rest_edge_lengths = {{1, 1.5, 1}, {1, 1, 1.5}};
    layout.rest_corners = {{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}, {Vec2(5, 0), Vec2(5, 1), Vec2(4, 1)}};
    layout.triangle_panel = {0, 1};
    layout.seam_pairs = {{0, 3}};
    layout.panel_names = {"front", "back"};
    layout.version = "1.2.3";
    return layout;
}

}  // namespace selvage
