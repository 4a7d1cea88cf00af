#include <catch2/catch.hpp>

#include <Eigen/Dense>

#include "host/solver/linear_solver.hpp"
#include "validation/unit/small_cloth.hpp"

using namespace selvage;

namespace {

// The field that a term's value depends on: positions, or velocities for a dissipative one.
std::vector<real>& argument(const Term& term, State& state)
{
    return term.nature == Nature::conservative ? state.pos : state.vel;
}

void rotate_and_shift(State& state)
{
    const Mat3 turn = Eigen::AngleAxisd(0.8, Vec3(1, 2, -1).normalized()).toRotationMatrix();
    const int vs = state.size.vertex_stride;
    for (int v = 0; v < state.size.vertex_count; ++v) {
        const Vec3 moved = turn * Vec3(state.pos[v], state.pos[vs + v], state.pos[2 * vs + v]) + Vec3(0.3, -2, 5);
        for (int c = 0; c < 3; ++c) state.pos[c * vs + v] = moved[c];
    }
}

// What a plate keeps out of its slots: J^T (G - W) J.
void add_couplings(const State& state, Eigen::MatrixXd& dense)
{
    const int hinges = state.size.hinge_count, hs = state.size.hinge_stride;
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(hinges, dense.cols());
    Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(hinges, hinges);
    for (int h = 0; h < hinges; ++h) {
        for (int c = 0; c < 12; ++c) slopes(h, 3 * state.hinge_vertex[c / 3 * hs + h] + c % 3) += state.hinge_slope[12 * h + c];
        for (int k = state.coupling_slots[h]; k < state.coupling_slots[hs + h]; ++k)
            rest(h, state.coupling_hinge[k]) = state.coupling_rigidity[k];
        rest(h, h) -= state.hinge_rigidity[h];
    }
    dense += slopes.transpose() * rest * slopes;
}

// The assembled stiffness of one term as a dense matrix over the active degrees of freedom, from its columns.
Eigen::MatrixXd dense_stiffness(const Term& term, State& state, const Params& params, bool projected)
{
    clear_stiffness(state);
    term.add_stiffness(state, params, projected);
    const std::vector<int> dofs = active_dofs(state);
    const int n = state.size.vertex_count;
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    for (int v = 0; v < n && !state.vertex_stiffness.empty(); ++v)
        for (int c = 0; c < 9; ++c) dense(3 * v + c / 3, 3 * v + c % 3) += state.vertex_stiffness[9 * v + c];
    const auto add_elements = [&](int corners, int count, int stride, const auto& vertex, const auto& stiffness) {
        for (int e = 0; e < count && !stiffness.empty(); ++e)
            for (int a = 0; a < corners; ++a)
                for (int b = a + 1; b < corners; ++b)
                    for (int c = 0; c < 9; ++c) {
                        const double k = stiffness[9 * (std::size_t(block_index(corners, a, b)) * stride + e) + c];
                        const int va = 3 * vertex[a * stride + e], vb = 3 * vertex[b * stride + e];
                        dense(va + c / 3, vb + c % 3) += k;
                        dense(vb + c % 3, va + c / 3) += k;
                        dense(va + c / 3, va + c % 3) -= k;
                        dense(vb + c % 3, vb + c / 3) -= k;
                    }
    };
#define ADD(kind, corners) \
    add_elements(corners, state.size.kind##_count, state.size.kind##_stride, state.kind##_vertex, state.kind##_stiffness);
    ELEMENT_KINDS(ADD)
#undef ADD
    if (term.fields[std::size_t(Field::hinge_slope)]) add_couplings(state, dense);
    return dense;
}

}  // namespace

TEST_CASE("every term's force is minus the gradient of its value", "[terms]")
{
    const Params params = unit_strengths();
    for (const Term& term : all_terms()) {
        INFO("term " << term.name);
        State state = crumpled_state(params);
        const std::vector<real> force = term_force(term, state, params);
        const real h = 1e-7;
        for (int dof : active_dofs(state)) {
            real& x = argument(term, state)[dof];
            const real at = x;
            x = at + h;
            const double above = term.energy(state, params);
            x = at - h;
            const double below = term.energy(state, params);
            x = at;
            CHECK(force[dof] == Approx(-(above - below) / (2 * h)).epsilon(1e-5).margin(1e-7));
        }
    }
}

TEST_CASE("every term's exact stiffness is minus the gradient of its force", "[terms]")
{
    const Params params = unit_strengths();
    for (const Term& term : all_terms()) {
        INFO("term " << term.name);
        State state = crumpled_state(params);
        const Eigen::MatrixXd stiffness = dense_stiffness(term, state, params, false);
        CHECK((stiffness - stiffness.transpose()).norm() <= 1e-6 * stiffness.norm());
        const std::vector<int> dofs = active_dofs(state);
        const int n = state.size.vertex_count;
        const real h = 1e-8;
        double worst = 0;
        for (int j = 0; j < 3 * n; ++j) {
            real& x = argument(term, state)[dofs[j]];
            const real at = x;
            x = at + h;
            const std::vector<real> above = term_force(term, state, params);
            x = at - h;
            const std::vector<real> below = term_force(term, state, params);
            x = at;
            for (int i = 0; i < 3 * n; ++i) {
                const double expected = -(above[dofs[i]] - below[dofs[i]]) / (2 * h);
                const double k = stiffness(3 * (i % n) + i / n, 3 * (j % n) + j / n);
                worst = std::max(worst, std::abs(k - expected));
            }
        }
        CHECK(worst <= 2e-6 * stiffness.norm() + 1e-9);
    }
}

TEST_CASE("every term's projected stiffness has no negative eigenvalue", "[terms]")
{
    const Params params = unit_strengths();
    for (const Term& term : all_terms()) {
        INFO("term " << term.name);
        State state = crumpled_state(params, 3);
        const Eigen::MatrixXd stiffness = dense_stiffness(term, state, params, true);
        const double lowest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness).eigenvalues()[0];
        CHECK(lowest >= -1e-6 * stiffness.norm());   // the slots hold floats
    }
}

TEST_CASE("terms inside the cloth do not see rigid motion and exert no net force or torque", "[terms]")
{
    const Params params = unit_strengths();
    for (const Term& term : all_terms()) {
        if (term.per == ItemKind::vertex) continue;
        INFO("term " << term.name);
        State state = crumpled_state(params);
        const double before = term.energy(state, params);
        const std::vector<real> force = term_force(term, state, params);
        const int vs = state.size.vertex_stride;
        Vec3 net = Vec3::Zero(), torque = Vec3::Zero();
        double size = 0;
        for (int v = 0; v < state.size.vertex_count; ++v) {
            const Vec3 f(force[v], force[vs + v], force[2 * vs + v]);
            net += f;
            torque += Vec3(state.pos[v], state.pos[vs + v], state.pos[2 * vs + v]).cross(f);
            size += f.norm();
        }
        CHECK(net.norm() <= 1e-13 * size);
        CHECK(torque.norm() <= 1e-13 * size);
        rotate_and_shift(state);
        CHECK(term.energy(state, params) == Approx(before).epsilon(1e-11));
    }
}

TEST_CASE("dissipative terms never add energy", "[terms]")
{
    const Params params = unit_strengths();
    for (const Term& term : all_terms()) {
        if (term.nature != Nature::dissipative) continue;
        INFO("term " << term.name);
        State state = crumpled_state(params);
        const std::vector<real> force = term_force(term, state, params);
        double power = 0;
        for (int dof : active_dofs(state)) power += force[dof] * state.vel[dof];
        CHECK(power < 0);
    }
}

TEST_CASE("a term with zero strength takes no memory", "[terms][plan]")
{
    for (const Term& term : all_terms()) CHECK_FALSE(term.is_active(Params{}));
    const Topology topology = make_topology(grid_cloth(3, 3), false);
    const State state(topology_sizes(topology, 1), required_fields(Params{}));
    CHECK(state.hinge_force.empty());
    CHECK(state.face_vertex.empty());
    CHECK(state.contact_normal.empty());
}

TEST_CASE("linear solvers of both precisions and preconditioners agree with a dense solve", "[terms][linear]")
{
    Params params;
    params.membrane.scale = 1;
    params.plate.scale = 1;
    const Cloth cloth = grid_cloth(9, 9), half = grid_cloth(5, 5, 0.2);
    const Topology fine = make_topology(cloth, false), coarse = make_topology(half, false);
    State state = make_state(fine, cloth, test_fabrics(), params, cloth.positions, {});
    Transfer transfer{{0}, {}, {}};
    for (int r = 0; r < 9; ++r)
        for (int c = 0; c < 9; ++c) {
            for (int i : {r / 2, (r + 1) / 2})
                for (int j : {c / 2, (c + 1) / 2}) {
                    transfer.column.push_back(5 * i + j);
                    transfer.weight.push_back(0.25);
                }
            transfer.offset.push_back(int(transfer.column.size()));
        }
    const ParticleTransfers transfers{particle_transfer(transfer, coarse, fine)};
    std::vector<real> b(state.pos.size()), x(state.pos.size());
    for (int dof : active_dofs(state)) b[dof] = std::sin(0.37 * dof);

    const std::vector<int> dofs = active_dofs(state);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(243, 243);
    for (const Term& term : all_terms())
        if (term.is_active(params)) dense += dense_stiffness(term, state, params, true);
    Eigen::VectorXd rhs(243);
    for (int i = 0; i < 243; ++i) {
        rhs[3 * (i % 81) + i / 81] = b[dofs[i]];
        dense(3 * (i % 81) + i / 81, 3 * (i % 81) + i / 81) += 100 * state.mass[i % 81];
    }
    const Eigen::VectorXd expected = dense.ldlt().solve(rhs);

    clear_stiffness(state);
    for (const Term& term : all_terms())
        if (term.is_active(params)) term.add_stiffness(state, params, true);
    for (Preconditioner preconditioner : {Preconditioner::block_jacobi, Preconditioner::multigrid})
        for (bool in_double : {true, false}) {
            const LinearOptions options{preconditioner, 2000};
            const auto solver = in_double ? make_linear_solver_double(state, options, transfers)
                                          : make_linear_solver_float(state, options, transfers);
            solver->assemble(state, 100);
            const LinearResult result = solver->solve(b.data(), in_double ? 1e-12 : 1e-5, x.data());
            CHECK_FALSE(result.negative_curvature);
            for (int i = 0; i < 243; ++i)
                CHECK(x[dofs[i]] == Approx(expected[3 * (i % 81) + i / 81]).margin(in_double ? 1e-9 : 1e-3));
        }
}
