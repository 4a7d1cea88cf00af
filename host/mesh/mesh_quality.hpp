#pragma once
#include <vector>

#include "host/mesh/delaunay.hpp"
#include "host/mesh/size_field.hpp"

namespace selvage {

/// A panel being meshed: its triangulation and the edge length wanted, both in grid steps.
struct PanelDraft {
    Triangulation triangulation;
    SizeField size;
    int boundary_count;  ///< Vertices 0, 1, ... that must not move.
};

/// Returns the smallest angle of a triangle [degrees]; 0 or less if it is flat or turned over.
double smallest_angle(const GridPoint& a, const GridPoint& b, const GridPoint& c);

/// Moves interior vertices to even out the triangles: optimal Delaunay smoothing with the density size^-4
/// (Chen and Holst 2011, equation 4.8), then flips back to Delaunay.
void smooth(PanelDraft& draft, int rounds);

/// Improves triangles with angles below `degrees`: removes crowded vertices, fills holes, moves single vertices.
void repair(PanelDraft& draft, double degrees);

}  // namespace selvage
