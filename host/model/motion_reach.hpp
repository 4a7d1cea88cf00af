#pragma once
#include "host/model/body.hpp"

namespace selvage {

/// Where cloth may come that starts in a box, by swinging to all sides and falling. @param down  gravity, of any length
Box swing_reach(const Box& start, const Vec3& down);

/// Whether the motion of a body leads through a reach; false for one that stands still, true for a plane that moves.
bool moves_within(const Body& body, const Box& reach);

}  // namespace selvage
