#pragma once
#include <cstddef>

#include "host/solver/linear/linear_solver.hpp"
#include "host/solver/state/state.hpp"

namespace selvage {

// Bytes that one call must move, counted as in terms/traffic.hpp; scalars of the linear solver are doubles.

/// Element and vertex stiffness, gather lists, the matrix written, and the inverse diagonal blocks made from it.
std::size_t assemble_bytes(const State& state, const BlockPattern& pattern);
/// Of the whole product: the matrix, the couplings of plate hinges and the pairs in contact, which do not stand in it.
std::size_t product_bytes(const State& state, const BlockPattern& pattern);
std::size_t block_jacobi_bytes(const BlockPattern& pattern);
std::size_t dot_bytes(const BlockPattern& pattern);
std::size_t update_bytes(const BlockPattern& pattern);  ///< Of x += a p, r -= a q.
/// Of one V-cycle: all passes of Multigrid::cycle over all levels, the coarse patterns being those of P^T A P.
std::size_t multigrid_bytes(const BlockPattern& finest, const ParticleProlongations& prolongations);

/// Which blocks the matrix of a topology has, without the places of elements. @param bends  hinges add to it
BlockPattern pattern_of(const Topology& topology, bool bends);

/// What a linear solver will hold, in the sizes of LinearSolver::bytes().
/// @param scalar  bytes of its numbers   @param prolongations  empty: block Jacobi instead of multigrid
std::size_t linear_solver_bytes(const BlockPattern& finest, const ParticleProlongations& prolongations,
                                std::size_t scalar);

}  // namespace selvage
