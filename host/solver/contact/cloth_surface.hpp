#pragma once
#include <vector>

#include "host/collision/cloth_tree.hpp"
#include "host/model/body.hpp"
#include "host/model/cloth.hpp"
#include "host/solver/state/topology.hpp"

namespace selvage {

/// The surface of a cloth that a tree is built over, in the numbering of the topology's particles.
TreeSurface tree_surface(const Topology& topology, const Cloth& cloth);

/// Adds the surfaces of bodies to it.
void add_bodies(TreeSurface& surface, const std::vector<Body>& bodies);

}  // namespace selvage
