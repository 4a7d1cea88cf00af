#pragma once
#include <memory>

#include "host/solver/linear/linear_solver.hpp"

namespace selvage {

/// Makes a solver by sparse Cholesky factorisation, with which small systems of any stiffness reach rounding error. A
/// matrix that is not positive definite is shifted by a multiple of the identity until it is, which turns Newton's step
/// towards the negative gradient.
/// @param plane  true: the unknowns along z are left out, so that the cloth stays in its plane
std::unique_ptr<LinearSolver> make_direct_solver(bool plane);

}  // namespace selvage
