#pragma once
#include <vector>

#include "host/model/body.hpp"
#include "host/model/cloth.hpp"

namespace selvage {

/// Returns the vertices of a closed mesh moved inwards by a part of the radius of the largest ball that touches the
/// surface there from within (the shrinking-ball method of Ma, Bae and Choi 2012), radii and ways being smoothed over
/// the surface. Limbs become thin and stay where they are; what lies on one side of a limb lies there still.
/// @param part  of the radius, 0 to below 1 [1]
std::vector<Vec3> thin_vertices(const TriangleMesh& mesh, double part);

/// Returns the bodies with those of meshes made thin, and at rest. @param part  as for thin_vertices
std::vector<Body> thin_bodies(const std::vector<Body>& bodies, double part);

/// Returns thin bodies that grow back to what they are: from `start` on, for `length`, ever more slowly [s].
/// @param thin   of thin_bodies
/// @param whole  the bodies themselves, where they are at time 0
std::vector<Body> growing_bodies(const std::vector<Body>& thin, const std::vector<Body>& whole, double start,
                                 double length);

/// True if a seam has a pair whose vertices start apart, and the straight way between them meets a body of a mesh where
/// it is at time 0: pulled straight the pair would press on the body from both sides.
bool seams_meet_bodies(const Cloth& cloth, const std::vector<Body>& bodies);

}  // namespace selvage
