#pragma once
#include "io/choices.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// Returns the rotation that maps a file's up direction to z:
/// x: (x, y, z) -> (y, z, x);  y: (x, y, z) -> (x, -z, y);  z: the identity.
inline Mat3 z_up_from(Axis up_axis)
{
    Mat3 turn = Mat3::Identity();
    if (up_axis == Axis::y) turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    if (up_axis == Axis::x) turn << 0, 1, 0, 0, 0, 1, 1, 0, 0;
    return turn;
}

}  // namespace selvage
