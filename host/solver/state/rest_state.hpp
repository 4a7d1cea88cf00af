#pragma once
#include <array>
#include <vector>

#include "host/model/cloth_model.hpp"
#include "host/solver/state/state.hpp"
#include "host/solver/state/topology.hpp"

namespace selvage {

/// Puts the particles of a filled state where the cloth is; pinned ones are at rest.
/// Positions are set to the mass-weighted mean of the cloth vertices of each particle, velocities likewise, so that
/// joining keeps the centre of mass and the momentum.
/// @param positions   per cloth vertex [m]
/// @param velocities  per cloth vertex [m/s]; empty: at rest
void place_particles(State& state, const Topology& topology, const Cloth& cloth, const FabricTable& fabrics,
                     const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities);

/// Fills the rest data of an allocated state: masses, faces, hinges, stitches, materials and gather lists; then as
/// above.
void fill_state(State& state, const Topology& topology, const Cloth& cloth, const FabricTable& fabrics,
                const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities);

/// Returns the position [m] or velocity [m/s] of every cloth vertex from a particle field with three components.
std::vector<Vec3> cloth_vectors(const Topology& topology, const mesh_sizes& size, const std::vector<real>& field);

/// Inverse of the rest edge matrix of a face, by rows: (weft, warp) weights of corners 1 and 2 [1/m]; see membrane.h.
std::array<double, 4> face_rest_weights(const Cloth& cloth, int face);

}  // namespace selvage
