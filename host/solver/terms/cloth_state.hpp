#pragma once
#include "host/solver/state/topology.hpp"
#include "host/solver/terms/params.hpp"

namespace selvage {

/// Allocates what the active terms of `params` need and fills it with the cloth's rest data; see fill_state.
State make_state(const Topology& topology, const Cloth& cloth, const FabricTable& fabrics, const Params& params,
                 const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities);

}  // namespace selvage
