#pragma once
#include <vector>

#include "host/solver/stepping/system.hpp"

namespace selvage {

/// Puts all but some vertices to sleep: as good as pinned, and no element, matrix row or part of the contact tree that
/// lies among them is looked at. Their velocities become zero. The forces must have been evaluated where the cloth is,
/// since plates couple hinges that are awake to the turns of those asleep.
/// @param is_awake       per vertex: 1 if it stays awake
/// @param force_squared  see AwakeItems
void put_to_sleep(System& system, const std::vector<char>& is_awake, double force_squared);

/// Wakes all.
void wake(System& system);

/// Whether parts of the cloth may sleep: no velocity filter acts on it, and nothing has to be untangled.
bool may_sleep(const System& system);

/// On the way to rest cloth comes to rest in places: where one fold snaps into the next, all else stands still for many
/// steps. Called after each step, puts what hardly moves to sleep for some steps, and wakes it. state.vel must be that
/// of the step.
/// @param force       System::static_force at its end
/// @param steps_left  for which parts of the cloth will sleep; 0: all is awake
void rest_in_places(System& system, const std::vector<real>& force, int& steps_left);

}  // namespace selvage
