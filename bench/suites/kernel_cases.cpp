#include "bench/suites/kernel_cases.hpp"

#include <memory>
#include <string_view>
#include <utility>

#include <benchmark/benchmark.h>

#include "host/solver/contact/anchors.hpp"
#include "host/solver/linear/linear_traffic.hpp"
#include "host/solver/stepping/newton.hpp"
#include "host/solver/terms/traffic.hpp"

namespace selvage {
namespace {

constexpr double step_length = 0.02;                         // as in a run [s]
constexpr double inertia = 1 / (step_length * step_length);  // [1/s^2]

KernelCase vertex_case(const KernelCloth& cloth, std::string name, std::size_t bytes, std::function<void()> run)
{
    return {.name = std::move(name),
            .item = "vertex",
            .items = cloth.state.size.vertex_count,
            .bytes = bytes,
            .run = std::move(run)};
}

KernelCase body_query_case(KernelCloth& cloth)
{
    const auto body = std::make_shared<std::vector<int>>(cloth.state.size.vertex_count);
    return vertex_case(cloth, "body_query", body_query_bytes(cloth.state), [&cloth, body] {
        State& s = cloth.state;
        const int vs = s.size.vertex_stride;
        cloth.query->nearest(s.pos.data(), vs, s.size.vertex_count, cloth.contact->search_radius(),
                             {vs, s.contact_normal.data(), s.contact_offset.data(), body->data()});
    });
}

void add_terms(KernelCloth& cloth, TermPart part, std::vector<KernelCase>& cases)
{
    constexpr const char* part_names[] = {"/value", "/force", "/stiffness"};
    for (const Term& term : all_terms())
        cases.push_back({.name = std::string(term.name) + part_names[int(part)],
                         .item = std::string(kind_name(term.per)),
                         .items = term.item_count(cloth.state.size),
                         .bytes = term_bytes(term, cloth.state, part),
                         .run = [&cloth, &term, part] {
                             if (part == TermPart::value)
                                 benchmark::DoNotOptimize(term.energy(cloth.state, cloth.params));
                             if (part == TermPart::force) term.add_force(cloth.state, cloth.params);
                             if (part == TermPart::stiffness) term.add_stiffness(cloth.state, cloth.params, true);
                         }});
}

void evaluate_forces(KernelCloth& cloth)
{
    clear_forces(cloth.state);
    for (const Term& term : all_terms()) term.add_force(cloth.state, cloth.params);
    gather_forces(cloth.state);
}

void evaluate_stiffness(KernelCloth& cloth)
{
    clear_stiffness(cloth.state);
    for (const Term& term : all_terms()) term.add_stiffness(cloth.state, cloth.params, true);
}

KernelCase operation_case(KernelCloth& cloth, std::string name, LinearSolver& solver, LinearOperation operation,
                          std::size_t bytes)
{
    KernelCase kernel = vertex_case(cloth, std::move(name), bytes, [&solver, operation] { solver.run(operation); });
    kernel.prepare = [&cloth, &solver] {  // a short solve gives the solver's vectors realistic values
        evaluate_forces(cloth);
        evaluate_stiffness(cloth);
        std::vector<real> solution(cloth.state.force.size());
        solver.assemble(cloth.state, inertia);
        solver.solve(cloth.state.force.data(), {.residual = 0.5}, solution.data());
    };
    return kernel;
}

void add_linear_solver(KernelCloth& cloth, std::vector<KernelCase>& cases)
{
    const BlockPattern& pattern = cloth.pattern;
    KernelCase assemble = vertex_case(cloth, "assemble", assemble_bytes(cloth.state, pattern),
                                      [&cloth] { cloth.block_jacobi->assemble(cloth.state, inertia); });
    assemble.prepare = [&cloth] { evaluate_stiffness(cloth); };
    cases.push_back(assemble);

    LinearSolver &one_level = *cloth.block_jacobi, &all_levels = *cloth.multigrid;
    using enum LinearOperation;
    cases.push_back(operation_case(cloth, "matrix_product", one_level, product, product_bytes(cloth.state, pattern)));
    cases.push_back(
        operation_case(cloth, "precondition/block_jacobi", one_level, precondition, block_jacobi_bytes(pattern)));
    cases.push_back(operation_case(cloth, "precondition/multigrid", all_levels, precondition,
                                   multigrid_bytes(pattern, cloth.prolongations)));
    cases.push_back(operation_case(cloth, "dot", one_level, dot, dot_bytes(pattern)));
    cases.push_back(operation_case(cloth, "axpy", one_level, update, update_bytes(pattern)));
}

/// One Newton iteration of an implicit step, including the body query and the gradient that test for convergence.
struct NewtonIteration {
    explicit NewtonIteration(KernelCloth& cloth)
        : system(cloth.state, cloth.params, profile, {.bodies = cloth.contact}), newton(system, *cloth.multigrid)
    {
    }
    NewtonReport run()
    {
        NewtonOptions options;
        options.max_iterations = 1;
        options.tolerance = 0;
        return implicit_euler_step(newton, step_length, options);
    }

    Profile profile;
    System system;  // with a state of its own
    Newton newton;
};

// The bytes that one Newton iteration must move: the sum over its stages, each times its number of calls. Vector
// updates outside the linear solve and the assembly of multigrid's coarse matrices are not counted.
std::size_t newton_bytes(const KernelCloth& cloth, const NewtonReport& report, const Profile& profile)
{
    const auto calls = [&profile](std::string_view name) {
        for (const KernelRecord& record : profile.records())
            if (record.name == name) return std::size_t(record.calls);
        return std::size_t(0);
    };
    const State& state = cloth.state;
    // The profile records energy and force evaluations of a term under one name, so their counts are separated here.
    const std::size_t gradients = calls("gather_forces"), objectives = calls("gravity") - gradients;
    std::size_t total = calls("body_query") * body_query_bytes(state) + settle_friction_bytes(state) +
                        settle_hysteresis_bytes(state) + gradients * (clear_forces_bytes(state) + gather_bytes(state)) +
                        calls("assemble") * (clear_stiffness_bytes(state) + assemble_bytes(state, cloth.pattern));
    for (const Term& term : all_terms())
        total += objectives * term_bytes(term, state, TermPart::value) +
                 gradients * term_bytes(term, state, TermPart::force) +
                 calls("assemble") * term_bytes(term, state, TermPart::stiffness);
    const std::size_t direction = update_bytes(cloth.pattern) / 2;  // p = z + turn p
    return total +
           std::size_t(report.linear_iterations) *
               (product_bytes(cloth.state, cloth.pattern) + multigrid_bytes(cloth.pattern, cloth.prolongations) +
                3 * dot_bytes(cloth.pattern) + update_bytes(cloth.pattern) + direction);
}

KernelCase newton_case(KernelCloth& cloth)
{
    const auto iteration = std::make_shared<NewtonIteration>(cloth);
    const NewtonReport report = iteration->run();
    KernelCase kernel = vertex_case(cloth, "newton_iteration", newton_bytes(cloth, report, iteration->profile),
                                    [iteration] { iteration->run(); });
    kernel.reset = [&cloth, iteration] {
        cloth.reset();
        iteration->system.state() = cloth.state;
    };
    kernel.reset();
    return kernel;
}

}  // namespace

std::vector<KernelCase> kernel_cases(KernelCloth& cloth)
{
    const State& state = cloth.state;
    std::vector<KernelCase> cases = {body_query_case(cloth)};
    cases.push_back(
        vertex_case(cloth, "clear_forces", clear_forces_bytes(state), [&cloth] { clear_forces(cloth.state); }));
    add_terms(cloth, TermPart::force, cases);
    cases.push_back(vertex_case(cloth, "gather_forces", gather_bytes(state), [&cloth] { gather_forces(cloth.state); }));
    cases.push_back(vertex_case(cloth, "clear_stiffness", clear_stiffness_bytes(state),
                                [&cloth] { clear_stiffness(cloth.state); }));
    add_terms(cloth, TermPart::stiffness, cases);
    add_linear_solver(cloth, cases);
    add_terms(cloth, TermPart::value, cases);
    cases.push_back(vertex_case(cloth, "settle_friction", settle_friction_bytes(state),
                                [&cloth] { settle_friction(cloth.state, cloth.params); }));
    cases.push_back({.name = "settle_hysteresis",
                     .item = "hinge",
                     .items = state.size.hinge_count,
                     .bytes = settle_hysteresis_bytes(state),
                     .run = [&cloth] { settle_hysteresis(cloth.state, cloth.params); }});
    cases.push_back(newton_case(cloth));
    return cases;
}

}  // namespace selvage
