#pragma once
#include "host/model/cloth.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// Sews a scene's [[garment.elastic]] to its garment.
/// @throws InputError for a panel or an edge that does not exist
void sew_elastics(Cloth& garment, const Scene& scene);

/// Holds the vertices of a cloth that a scene's [pins], [[pins.hold]] and [[pins.motion]] name.
/// @param finest  the cloth is that of the scene itself: indices of vertices are those of the finest mesh, and coarser
///                cloths hold groups only
/// @throws InputError for a panel or a vertex that does not exist
void pin_cloth(Cloth& cloth, const Scene& scene, bool finest);

/// Vertices are held by their indices, which coarser cloths do not have.
bool pins_by_index(const Scene& scene);

}  // namespace selvage
