#pragma once
#include "host/collision/cloth_tree.hpp"

namespace selvage {

/// Counts the pairs of an edge and a face of the cloth that pass through each other: 0 means that the cloth is free of
/// intersections. Edges that end at a corner of the face do not count. Parts that are provably apart are not looked at
/// (see ClothTree), so that a sheet without folds costs little more than a pass over its faces.
/// @param surface   of the cloth alone
/// @param position  planes, component c of particle v at [c * stride + v] [m]
int count_crossings(const TreeSurface& surface, const double* position, int stride, int particle_count);

}  // namespace selvage
