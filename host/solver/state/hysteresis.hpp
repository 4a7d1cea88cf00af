#pragma once
#include "host/model/cloth_model.hpp"
#include "host/solver/state/topology.hpp"

namespace selvage {

/// Fills each hinge's friction moment L [N m] and width (A1 + A2) / |e| [m]; anchors start at the rest shape.
///     L = |e| (c_u HB_u n_u^2 + c_v HB_v n_v^2),   n the edge's normal, HB = hysteresis / 2 along weft u and warp v
/// The factors c of a panel make cylinders bent along weft and along warp show HB, by virtual work:
///     sum_h L_h |dphi_h/dkappa| = HB A,   A the panel's area
/// with the rows of PlateMesh for dphi/dkappa. As for the plate, a face at a free edge counts in A only along the
/// edge: the edge itself carries no moment. A hinge between two panels takes half of either's moment.
/// The hinges of irregular meshes turn in both cylinders alike, with about a third where their edge runs along the
/// curve: there the weaker direction never shows less than some 0.3 of the stronger.
/// @param state  allocated, with hinge_hysteresis among its fields
/// @param cloth  in the numbering of the topology's faces; all fabrics of its panels must be in `fabrics`
void fill_hysteresis(State& state, const Topology& topology, const Cloth& cloth, const FabricTable& fabrics);

}  // namespace selvage
