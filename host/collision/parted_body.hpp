#pragma once
#include <vector>

#include "host/model/body.hpp"

namespace selvage {

/// Returns bodies in which cloth fits between parts that touch or overlap, such as thighs: where two parts of the
/// surface of a mesh body face each other nearer than `room`, both give way along their normals by half of what is
/// missing, smoothly and by at most a part of their thickness, in the lower half of the body, legs and seat. Bodies
/// that move stay as they are.
/// @param room  [m]   @param region  only points within give way
std::vector<Body> parted_bodies(const std::vector<Body>& bodies, double room, const Box& region);

}  // namespace selvage
