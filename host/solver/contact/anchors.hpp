#pragma once
#include "host/solver/state/state.hpp"
#include "host/solver/terms/params.hpp"

namespace selvage {

/// Lets every friction anchor slip to within the stick distance and sets the limits from the normal forces.
/// Called when a step is done: within a step limits and anchors are fixed.
void settle_friction(State& state, const Params& params);

/// Places the anchors of vertices at rest so that friction balances, as far as its limit allows, the tangential part of
/// state.force, in which friction itself must be zero yet. Called once, after the first settling.
void hold_by_friction(State& state, const Params& params);

/// Lets every hinge's anchor slip to within the stick turn: kernels/stages/settle_hysteresis.h.
void settle_hysteresis(State& state, const Params& params);

/// Ends a step for all that slips, contact and bending alike. Within a step anchors and limits are fixed.
void settle_anchors(State& state, const Params& params);

}  // namespace selvage
