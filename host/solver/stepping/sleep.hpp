#pragma once
#include <vector>

#include "host/solver/stepping/phase.hpp"

namespace selvage {

/// Puts all but some vertices to sleep: as good as pinned, and no element, matrix row or part of the contact tree that
/// lies among them is looked at. Their velocities become zero. The phase must have been evaluated where it is.
/// @param is_awake       per vertex: 1 if it stays awake
/// @param force_squared  see AwakeItems
void put_to_sleep(Phase& phase, const std::vector<char>& is_awake, double force_squared);

/// Wakes all.
void wake(Phase& phase);

/// Whether parts of the cloth may sleep: no rule acts on it, and nothing has to be untangled.
bool may_sleep(const Phase& phase);

/// On the way to rest cloth comes to rest in places: where one fold snaps into the next, all else stands still for many
/// steps (E7 has regions at rest sleep until something reaches them). Called after each step, puts what hardly moves to
/// sleep for some steps, and wakes it. state.vel must be that of the step, and Newton's last gradient the static one of
/// its end.
/// @param steps_left  for which parts of the cloth will sleep; 0: all is awake
void rest_in_places(Phase& phase, int& steps_left);

}  // namespace selvage
