#pragma once
#include <memory>

#include "host/solver/linear/linear_solver.hpp"

namespace selvage {

/// Solves by a sparse Cholesky factorisation, so that small systems of any stiffness reach rounding error. Where the
/// matrix is not positive definite it is shifted until it is, which turns Newton's step towards the gradient.
/// @param plane  the unknowns along z are left out: the cloth stays in its plane
std::unique_ptr<LinearSolver> make_direct_solver(bool plane);

}  // namespace selvage
