#pragma once
#include <cstddef>

#include "host/solver/state/state.hpp"

namespace selvage {

/// Finds which way the faces lie to the air, for the terms of kernels/terms/wind.h. The state must hold face_air.
void find_face_air(State& state);

/// Returns what that moves [bytes].
std::size_t face_air_bytes(const State& state);

}  // namespace selvage
