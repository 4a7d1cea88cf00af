#pragma once
#include <array>
#include <map>
#include <string>
#include <vector>

#include "host/model/cloth.hpp"
#include "host/solver/state/spring.hpp"
#include "host/solver/state/state.hpp"
#include "io/scene/fabric.hpp"

namespace selvage {

/// Which particles the vertices of a cloth are, and what connects them.
/// Sewn vertices become one particle; the flat cloth keeps its own vertices for rest shapes and output.
struct Topology {
    int particle_count = 0;
    std::vector<int> particle_of;            ///< Cloth vertex to particle.
    std::vector<Face> faces;                 ///< Corners as particles; same order as Cloth::faces.
    std::vector<std::array<int, 4>> hinges;  ///< Edge ends, then the corner opposite in each face (particles).
    std::vector<std::array<int, 2>> hinge_faces;
    std::vector<std::array<int, 2>> stitches;  ///< Pairs of particles that a seam force still pulls together.
    std::vector<Spring> springs;               ///< Of the spring model; see springs.hpp.
};

/// Connects the cloth.
/// @param joined  false: every vertex is a particle of its own and every seam pair is a stitch;
///                true: sewn vertices are one particle and no stitch is left.
Topology make_topology(const Cloth& cloth, bool joined);

/// Counts and padded strides of every kind of item.
/// @param coupling_count  entries of the plate's matrix; 0 without one
mesh_sizes topology_sizes(const Topology& topology, int material_count, int coupling_count = 0);

/// Fabrics in the order of the state's material table.
using FabricTable = std::map<std::string, Fabric>;

/// Puts the particles of a filled state where the cloth is; pinned ones are at rest.
/// Positions are set to the mass-weighted mean of the cloth vertices of each particle, velocities likewise, so that
/// joining keeps the centre of mass and the momentum (B12).
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
