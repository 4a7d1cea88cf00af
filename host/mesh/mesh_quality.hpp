#pragma once
#include <vector>

#include "host/mesh/delaunay.hpp"
#include "host/mesh/size_field.hpp"

namespace selvage {

/// A panel that is being meshed: its triangulation and the wanted edge length, both in grid steps.
struct PanelDraft {
    Triangulation triangulation;
    SizeField size;
    int boundary_count;  ///< Vertices 0, 1, ... that must not move.
};

/// Returns the smallest angle of a triangle [degrees]; 0 or less if it is flat or inverted.
double smallest_angle(const GridPoint& a, const GridPoint& b, const GridPoint& c);

/// Moves interior vertices by optimal Delaunay smoothing with the density size^-4 (Chen and Holst 2011, equation 4.8),
/// then restores the Delaunay property by flips.
void smooth(PanelDraft& draft, int rounds);

/// Improves triangles with angles below `degrees` by moving, removing and inserting single vertices.
void repair(PanelDraft& draft, double degrees);

}  // namespace selvage
