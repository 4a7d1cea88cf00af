#pragma once
#include "host/solver/state/state.hpp"
#include "host/solver/terms/params.hpp"

namespace selvage {

/// Lets every hinge's anchor slip to within the stick turn: kernels/stages/settle_hysteresis.h.
void settle_hysteresis(State& state, const Params& params);

/// Ends a step for all that slips, contact and bending alike. Within a step anchors and limits are fixed.
void settle_anchors(State& state, const Params& params);

}  // namespace selvage
