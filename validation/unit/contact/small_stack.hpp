#pragma once
#include <vector>

#include "host/solver/contact/ccd_filter.hpp"
#include "host/solver/contact/cloth_surface.hpp"
#include "host/solver/contact/contact_tuning.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "validation/measure/crumpled_sheets.hpp"

namespace selvage {

/// Sheets of side x side vertices, one above the other, shifted a little so that no edges lie on each other.
inline Cloth sheets_above_each_other(int count, int side, double spacing, double distance)
{
    Cloth cloth = grid_cloth(side, side, spacing);
    for (int k = 1; k < count; ++k)
        add_panel(cloth, grid_cloth(side, side, spacing), Vec3(0.003 * k, 0.005 * k, distance * k));
    return cloth;
}

inline Params contact_alone(double gap)
{
    Params params;
    params.cloth_contact.stiffness = 100;
    params.cloth_contact.gap = gap;
    params.cloth_friction.scale = 1;
    return params;
}

/// Sheets with a CCD filter of their own, and bodies if there are any.
struct FilteredSheets {
    Cloth cloth;
    ContactGaps gaps;
    Topology topology;
    State state;
    CrossingFlags crossings;
    std::vector<Vec3> corners;  ///< Of the bodies [m].
    CcdFilter filter;

    FilteredSheets(Cloth of, double gap, double spacing, const std::vector<Body>& bodies = {})
        : cloth(std::move(of)), gaps(gap), topology(make_topology(cloth, false)),
          state(make_state(topology, cloth, test_fabrics(), contact_alone(gap), cloth.positions, {})),
          crossings(std::size_t(topology.particle_count)), corners(surface(bodies).body_corners),
          filter(surface(bodies), ContactTuning::tree_slack * spacing, gaps, gap, crossings)
    {
        state.set_body_points(int(corners.size()));
    }

    TreeSurface surface(const std::vector<Body>& bodies) const
    {
        TreeSurface result = tree_surface(topology, cloth);
        add_bodies(result, bodies);
        return result;
    }

    int stride() const { return state.size.vertex_stride; }
    TreeBodies bodies() const { return {corners}; }

    /// Displacement planes that move a panel as a whole.
    std::vector<real> panel_displacement(int panel, const Vec3& by) const
    {
        std::vector<Vec3> displacement(cloth.positions.size(), Vec3::Zero());
        const ClothPanel& of = cloth.panels[panel];
        for (int v = of.first_vertex; v < of.first_vertex + of.vertex_count; ++v) displacement[v] = by;
        return as_planes(displacement, stride());
    }
};

/// The least distance that one step leaves a pair that starts at its gap or further away.
inline double least_distance(double gap, double pair_gap, double kept)
{
    const double floor = ContactTuning::floor * pair_gap;
    return floor + kept * (gap - floor);
}

}  // namespace selvage
