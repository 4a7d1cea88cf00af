#pragma once
#include <array>
#include <vector>

#include "host/model/cloth.hpp"
#include "host/solver/state/spring.hpp"
#include "host/solver/state/state.hpp"

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

/// Connects a cloth that is partly sewn.
/// @param welded  per pair of Cloth::seam_pairs, 1: its vertices are one particle; empty: none is
Topology make_topology(const Cloth& cloth, const std::vector<char>& welded);

/// Returns the pairs of a coarser cloth of the same pattern that are one particle there: those whose seam is welded
/// where they stand in it. @param welded  of the pairs of the fine cloth, as in make_topology
std::vector<char> coarser_welds(const Cloth& fine, const std::vector<char>& welded, const Cloth& coarse);

/// Counts and padded strides of every kind of item.
/// @param coupling_count  entries of the plate's matrix; 0 without one
mesh_sizes topology_sizes(const Topology& topology, int material_count, int coupling_count = 0);

}  // namespace selvage
