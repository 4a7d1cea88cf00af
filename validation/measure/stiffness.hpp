#pragma once
#include <vector>

#include <Eigen/SparseCore>

#include "host/solver/terms/terms.hpp"

namespace selvage {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Returns the stiffness that is in the slots of a state [N/m]; unknown 3 v + c is component c of vertex v.
/// @param coupled  true: add J^T (G - W) J, which the slots of a plate do not hold (see kernels/terms/plate.h)
SparseMatrix slot_stiffness(const State& state, bool coupled);

/// Returns the stiffness of one term at the present state [N/m]; of a dissipative term d2R/dv2 [kg/s].
SparseMatrix term_stiffness(const Term& term, State& state, const Params& params, bool projected);

/// Returns the exact second derivatives of the energy of all active conservative terms at the present state [N/m].
SparseMatrix exact_stiffness(State& state, const Params& params);

/// Returns the rows and columns `kept` of a matrix.
SparseMatrix submatrix(const SparseMatrix& matrix, const std::vector<int>& kept);

}  // namespace selvage
