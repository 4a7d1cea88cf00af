#pragma once
#include <vector>

#include <Eigen/Core>

#include "host/solver/terms/terms.hpp"

namespace selvage {

/// Returns the field that a term's value depends on: positions, or velocities for a dissipative term.
std::vector<real>& term_argument(const Term& term, State& state);

/// Returns the indices into `state.pos` that are not padding: x of all vertices, then y, then z.
std::vector<int> active_dofs(const State& state);

/// Returns the force of one term alone, indexed like `state.pos` [N].
std::vector<real> term_force(const Term& term, State& state, const Params& params);

/// Returns central differences of minus the term's value, indexed like `state.pos` [N].
std::vector<real> differenced_force(const Term& term, State& state, const Params& params);

/// Returns central differences of minus the term's force, in the order of active_dofs [N/m]. The stiffness of
/// cloth_contact and cloth_repulsion omits the change of normals and closest points, so both are held fixed for these.
Eigen::MatrixXd differenced_stiffness(const Term& term, State& state, const Params& params);

/// Returns the term's own stiffness in the same order [N/m].
/// @param projected  false: the exact one
Eigen::MatrixXd ordered_stiffness(const Term& term, State& state, const Params& params, bool projected);

}  // namespace selvage
