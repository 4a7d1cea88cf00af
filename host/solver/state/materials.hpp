#pragma once
#include "host/model/cloth_model.hpp"
#include "host/solver/state/topology.hpp"

namespace selvage {

/// Fills the material table of an allocated state: one row per fabric with its stress curves, over-elongation limits
/// included, and its coupling.
void fill_materials(State& state, const FabricTable& fabrics);

}  // namespace selvage
