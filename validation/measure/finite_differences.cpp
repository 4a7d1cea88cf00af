#include "validation/measure/finite_differences.hpp"

#include "host/parallel/launch.hpp"
#include "host/solver/terms/bound_args.hpp"
#include "kernels/terms/cloth_repulsion.h"
#include "validation/measure/stiffness.hpp"

namespace selvage {
namespace {

// Returns the force of contact at state.pos with the weights and normals that the state already holds.
template <auto Force, class Args>
std::vector<real> force_with_fixed_normals(State& state, const Params& params)
{
    const Args a = bound<Args>(state, params);
    const cloth_contact_args places = bound<cloth_contact_args>(state, params);
    const int ps = state.size.pair_stride;
    for (int p = 0; p < state.size.pair_count; ++p) {
        vec3 r = make_vec3(0, 0, 0);
        for (int i = 0; i < 4; ++i) r = r + a.pair_weight[i * ps + p] * pair_corner(i, p, &places);
        a.pair_distance[p] = dot(load3(a.pair_normal, ps, p), r);
    }
    clear_forces(state);
    launch<Force>(state.size.pair_count, a);
    gather_forces(state);
    return state.force;
}

}  // namespace

std::vector<real>& term_argument(const Term& term, State& state)
{
    return term.nature == Nature::conservative ? state.pos : state.vel;
}

std::vector<int> active_dofs(const State& state)
{
    std::vector<int> dofs;
    for (int c = 0; c < 3; ++c)
        for (int v = 0; v < state.size.vertex_count; ++v) dofs.push_back(c * state.size.vertex_stride + v);
    return dofs;
}

std::vector<real> term_force(const Term& term, State& state, const Params& params)
{
    clear_forces(state);
    term.add_force(state, params);
    gather_forces(state);
    return state.force;
}

std::vector<real> differenced_force(const Term& term, State& state, const Params& params)
{
    const real h = 1e-7;
    std::vector<real> force(state.pos.size());
    for (const int dof : active_dofs(state)) {
        real& x = term_argument(term, state)[dof];
        const real at = x;
        x = at + h;
        const double above = term.energy(state, params);
        x = at - h;
        const double below = term.energy(state, params);
        x = at;
        force[dof] = -(above - below) / (2 * h);
    }
    return force;
}

Eigen::MatrixXd differenced_stiffness(const Term& term, State& state, const Params& params)
{
    const real h = 1e-8;
    const std::vector<int> dofs = active_dofs(state);
    Eigen::MatrixXd stiffness(dofs.size(), dofs.size());
    const bool contact = term.name == "cloth_contact", repulsion = term.name == "cloth_repulsion";
    if (contact || repulsion) term_force(term, state, params);  // stores the pairs' weights and normals in the state
    const auto force = [&] {
        if (contact) return force_with_fixed_normals<cloth_contact_force, cloth_contact_args>(state, params);
        if (repulsion) return force_with_fixed_normals<cloth_repulsion_force, cloth_repulsion_args>(state, params);
        return term_force(term, state, params);
    };
    for (int j = 0; j < int(dofs.size()); ++j) {
        real& x = term_argument(term, state)[dofs[j]];
        const real at = x;
        x = at + h;
        const std::vector<real> above = force();
        x = at - h;
        const std::vector<real> below = force();
        x = at;
        for (int i = 0; i < int(dofs.size()); ++i) stiffness(i, j) = -(above[dofs[i]] - below[dofs[i]]) / (2 * h);
    }
    return stiffness;
}

Eigen::MatrixXd ordered_stiffness(const Term& term, State& state, const Params& params, bool projected)
{
    const Eigen::MatrixXd by_vertex = term_stiffness(term, state, params, projected);
    const int n = state.size.vertex_count;
    Eigen::MatrixXd ordered(3 * n, 3 * n);
    for (int i = 0; i < 3 * n; ++i)
        for (int j = 0; j < 3 * n; ++j) ordered(i, j) = by_vertex(3 * (i % n) + i / n, 3 * (j % n) + j / n);
    return ordered;
}

}  // namespace selvage
