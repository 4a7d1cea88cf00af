#pragma once
#include <array>
#include <vector>

#include "host/model/body.hpp"

namespace selvage {

/// The ends of the straight way between the two vertices of a seam pair [m].
using SeamWay = std::array<Vec3, 2>;

/// Returns bodies in which cloth fits between parts that touch or overlap, such as thighs: where two parts of the
/// surface of a mesh body face each other nearer than `room` and the way of a seam passes there, both give way along
/// their normals by half of what is missing, smoothly and by at most a part of their thickness, in the lower half of
/// the body, legs and seat. A skirt's seams pass elsewhere, and move nothing. Bodies that move stay as they are.
/// @param room  [m]   @param ways  of the seams
std::vector<Body> parted_bodies(const std::vector<Body>& bodies, double room, std::vector<SeamWay> ways);

}  // namespace selvage
