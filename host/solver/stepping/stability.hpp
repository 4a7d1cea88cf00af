#pragma once
#include "host/solver/stepping/phase.hpp"

namespace selvage {

/// Returns the highest angular frequency of small motions at the present state, from the projected stiffness [rad/s].
/// The estimate errs on the high side by at most a few per cent. Contact fields must be up to date.
/// Source: Lanczos 1950, on M^-1/2 K M^-1/2.
double highest_frequency(Phase& phase);

/// Returns the largest drag per mass of a vertex at the present state [1/s].
double largest_drag_rate(Phase& phase);

}  // namespace selvage
