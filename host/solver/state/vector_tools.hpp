#pragma once
#include <vector>

#include "host/solver/state/state.hpp"

namespace selvage {

/// Returns the largest distance of a vertex in `a` from itself in `b`; both are planes like state.pos.
double largest_distance(const State& state, const std::vector<real>& a, const std::vector<real>& b);

/// Returns true if no position and no velocity is infinite or not a number.
bool is_finite(const State& state);

}  // namespace selvage
