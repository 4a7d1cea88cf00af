#include <Eigen/Dense>

#include "host/solver/linear/linear_solver.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "host/solver/terms/unit_strengths.hpp"
#include "validation/measure/finite_differences.hpp"
#include "validation/measure/small_cloth.hpp"
#include "validation/measure/stiffness.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

void turn_and_shift(State& state, const Mat3& turn)
{
    const Planes x = vertex_planes(state.size, state.pos);
    for (int v = 0; v < x.count; ++v) x.set(v, turn * x(v) + Vec3(0.3, -2, 5));
}

}  // namespace

TEST_CASE("every term's force is minus the gradient of its value", "[terms]")
{
    const Params params = unit_strengths();
    for (const Term& term : all_terms()) {
        INFO("term " << term.name);
        State state = crumpled_state(params);
        const std::vector<real> force = term_force(term, state, params);
        const std::vector<real> expected = differenced_force(term, state, params);
        for (int dof : active_dofs(state)) CHECK(force[dof] == Approx(expected[dof]).epsilon(1e-5).margin(1e-7));
    }
}

TEST_CASE("every term's exact stiffness is minus the gradient of its force", "[terms]")
{
    const Params params = unit_strengths();
    for (const Term& term : all_terms()) {
        INFO("term " << term.name);
        State state = crumpled_state(params);
        const Eigen::MatrixXd stiffness = ordered_stiffness(term, state, params, false);
        CHECK((stiffness - stiffness.transpose()).norm() <= 1e-6 * stiffness.norm());
        const Eigen::MatrixXd expected = differenced_stiffness(term, state, params);
        CHECK((stiffness - expected).cwiseAbs().maxCoeff() <= 2e-6 * stiffness.norm() + 1e-9);
    }
}

TEST_CASE("every term's projected stiffness has no negative eigenvalue", "[terms]")
{
    const Params params = unit_strengths();
    for (const Term& term : all_terms()) {
        INFO("term " << term.name);
        State state = crumpled_state(params, 3);
        const Eigen::MatrixXd stiffness = ordered_stiffness(term, state, params, true);
        const double lowest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness).eigenvalues()[0];
        CHECK(lowest >= -1e-6 * stiffness.norm());  // the slots hold floats
    }
}

TEST_CASE("internal terms are invariant under rigid motions and exert no net force or torque", "[terms]")
{
    const Params params = unit_strengths();
    for (const Term& term : all_terms()) {
        if (term.per == ItemKind::vertex) continue;
        INFO("term " << term.name);
        State state = crumpled_state(params, 7, false);
        // Friction uses the normal and weights of the start of the step, which do not rotate with the cloth, and its
        // force is not central. It is therefore only invariant under translations.
        const bool held = term.name == "cloth_friction";
        const double before = term.energy(state, params);
        const std::vector<real> force = term_force(term, state, params);
        Vec3 net = Vec3::Zero(), torque = Vec3::Zero();
        double size = 0;
        for (int v = 0; v < state.size.vertex_count; ++v) {
            const Vec3 f = vertex_planes(state.size, force)(v);
            net += f;
            torque += vertex_planes(state.size, state.pos)(v).cross(f);
            size += f.norm();
        }
        CHECK(net.norm() <= 1e-13 * size);
        CHECK(size > 0);
        if (!held) CHECK(torque.norm() <= 1e-13 * size);
        const Mat3 turn = Eigen::AngleAxisd(0.8, Vec3(1, 2, -1).normalized()).toRotationMatrix();
        turn_and_shift(state, held ? Mat3(Mat3::Identity()) : turn);
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
    Prolongation prolongation{{0}, {}, {}};
    for (int r = 0; r < 9; ++r)
        for (int c = 0; c < 9; ++c) {
            for (int i : {r / 2, (r + 1) / 2})
                for (int j : {c / 2, (c + 1) / 2}) {
                    prolongation.column.push_back(5 * i + j);
                    prolongation.weight.push_back(0.25);
                }
            prolongation.offset.push_back(int(prolongation.column.size()));
        }
    const ParticleProlongations prolongations{particle_prolongation(prolongation, coarse, fine)};
    std::vector<real> b(state.pos.size()), x(state.pos.size());
    for (int dof : active_dofs(state)) b[dof] = std::sin(0.37 * dof);

    const std::vector<int> dofs = active_dofs(state);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(243, 243);
    for (const Term& term : all_terms())
        if (term.is_active(params)) dense += ordered_stiffness(term, state, params, true);
    Eigen::VectorXd rhs(243);
    for (int i = 0; i < 243; ++i) {
        rhs[i] = b[dofs[i]];
        dense(i, i) += 100 * state.mass[i % 81];
    }
    const Eigen::VectorXd expected = dense.ldlt().solve(rhs);

    clear_stiffness(state);
    for (const Term& term : all_terms())
        if (term.is_active(params)) term.add_stiffness(state, params, true);
    for (Preconditioner preconditioner : {Preconditioner::block_jacobi, Preconditioner::multigrid})
        for (bool in_double : {true, false}) {
            const LinearOptions options{preconditioner, 2000};
            const auto solver = in_double ? make_linear_solver_double(state, options, prolongations)
                                          : make_linear_solver_float(state, options, prolongations);
            solver->assemble(state, 100);
            const LinearResult result = solver->solve(b.data(), {.residual = in_double ? 1e-12 : 1e-5}, x.data());
            CHECK_FALSE(result.negative_curvature);
            for (int i = 0; i < 243; ++i) CHECK(x[dofs[i]] == Approx(expected[i]).margin(in_double ? 1e-9 : 1e-3));
        }
}

TEST_CASE("matrix-free products with contact and friction pairs equal those of the assembled matrix", "[terms][linear]")
{
    for (double friction : {0.0, 1.0}) {
        Params params = unit_strengths();
        params.cloth_friction.scale = friction;
        State state = crumpled_state(params);
        const int n = state.size.vertex_count, vs = state.size.vertex_stride;
        state.inv_mass[10] = 0;  // vertex 10 is in contact and pinned
        clear_stiffness(state);
        for (const Term& term : all_terms())
            if (term.is_active(params)) term.add_stiffness(state, params, true);
        Eigen::MatrixXd matrix = slot_stiffness(state, true);
        Eigen::VectorXd x(3 * n);
        std::vector<real> in(state.pos.size()), out(state.pos.size());
        for (int i = 0; i < 3 * n; ++i) {
            x[i] = state.inv_mass[i / 3] == 0 ? 0 : std::sin(1.3 * i + 1);
            in[i % 3 * vs + i / 3] = x[i];
            matrix(i, i) += 100 * state.mass[i / 3];
        }
        const Eigen::VectorXd expected = matrix * x;
        add_pair_diagonals(state);
        const auto solver = make_linear_solver_double(state, {}, {});
        solver->assemble(state, 100);
        solver->multiply(in.data(), out.data());
        for (int i = 0; i < 3 * n; ++i) {
            const double product = out[i % 3 * vs + i / 3];
            if (state.inv_mass[i / 3] == 0)
                CHECK(product == 0);
            else
                CHECK(product == Approx(expected[i]).margin(1e-6 * expected.norm()));  // the slots hold floats
        }
    }
}
