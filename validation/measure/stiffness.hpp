#pragma once
#include <vector>

#include <Eigen/SparseCore>

#include "host/solver/terms/terms.hpp"

namespace selvage {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// The stiffness that terms left in the slots of a state [N/m]; unknown 3 v + c is component c of vertex v.
/// @param coupled  add J^T (G - W) J, which a plate keeps out of its slots (see kernels/terms/plate.h)
SparseMatrix slot_stiffness(const State& state, bool coupled);

/// The stiffness of one term at the present state; of a dissipative one d2R/dv2.
SparseMatrix term_stiffness(const Term& term, State& state, const Params& params, bool projected);

/// Exact second derivatives of the energy of all active conservative terms at the present state.
SparseMatrix exact_stiffness(State& state, const Params& params);

/// The rows and columns `kept` of a matrix.
SparseMatrix submatrix(const SparseMatrix& matrix, const std::vector<int>& kept);

}  // namespace selvage
