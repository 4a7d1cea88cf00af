#pragma once
#include <vector>

#include "host/body/skin.hpp"

namespace selvage {

/// Where a geodesic distance starts from.
struct GeodesicSource {
    int vertex = 0;
    double distance = 0;  ///< That the vertex has from the start [m].
};

/// Returns the length of the shortest way over the smooth skin from the sources to every vertex [m]; infinity where
/// none leads. Marches outwards; within a triangle the distance is that from the point which has the distances of two
/// of its corners, so that ways run straight through the triangles of a flat part. On a sphere it is off by 1.3 % at
/// most. Source: Novotni and Klein 2002 (Computing geodesic distances on triangular meshes).
std::vector<double> geodesic_distances(const Skin& skin, const std::vector<GeodesicSource>& sources);

}  // namespace selvage
