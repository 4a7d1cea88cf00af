#pragma once
#include "host/model/cloth_model.hpp"
#include "host/solver/state/springs.hpp"
#include "host/solver/state/topology.hpp"
#include "host/solver/terms/params.hpp"

namespace selvage {

/// Returns the fields a scene with these parameters needs: positions, masses, and the union over its active
/// terms and velocity filters with their gather lists. A term whose strengths are all zero adds no field here and no
/// launch to a step.
FieldSet required_fields(const Params& params);

/// The springs that a phase with these parameters runs on.
SpringChoice springs_of(const Params& params);

/// Allocates what the active terms of `params` need and fills it with the cloth's rest data; see fill_state.
State make_state(const Topology& topology, const Cloth& cloth, const FabricTable& fabrics, const Params& params,
                 const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities);

}  // namespace selvage
