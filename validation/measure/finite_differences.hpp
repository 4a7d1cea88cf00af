#pragma once
#include <vector>

#include <Eigen/Core>

#include "host/solver/terms/terms.hpp"

namespace selvage {

/// The field that a term's value depends on: positions, or velocities for a dissipative one.
std::vector<real>& term_argument(const Term& term, State& state);

/// Indices into `state.pos` that belong to a vertex, not to padding: x of all vertices, then y, then z.
std::vector<int> active_dofs(const State& state);

/// The force of one term alone, indexed like `state.pos` [N].
std::vector<real> term_force(const Term& term, State& state, const Params& params);

/// Central differences of minus the term's value, indexed like `state.pos`.
std::vector<real> differenced_force(const Term& term, State& state, const Params& params);

/// Central differences of minus the term's force, in the order of active_dofs. Of cloth_contact, whose stiffness leaves
/// out how normals and closest points turn, with both kept.
Eigen::MatrixXd differenced_stiffness(const Term& term, State& state, const Params& params);

/// The term's own exact stiffness in the same order.
Eigen::MatrixXd ordered_stiffness(const Term& term, State& state, const Params& params, bool projected);

}  // namespace selvage
