#include "host/solver/stepping/stability.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Eigenvalues>

#include "host/parallel/launch.hpp"
#include "host/solver/state/vectors.hpp"
#include "kernels/stages/integrator_steps.h"

namespace selvage {
namespace {

constexpr int most_products = 80;
constexpr int products_between_looks = 10;
constexpr double accuracy = 0.02;  // of the eigenvalue, so half of it for the frequency

// Well mixed and the same in every run: no mode is missed by symmetry.
double mixed(std::uint32_t i)
{
    i = (i ^ (i >> 16)) * 0x45d9f3bu;
    i = (i ^ (i >> 16)) * 0x45d9f3bu;
    return double(i ^ (i >> 16)) / 2147483648.0 - 1;
}

// The largest eigenvalue of the tridiagonal matrix, and how far the true one may be from it.
struct Ritz {
    double value = 0, residual = 0;
};

Ritz largest_ritz(const std::vector<double>& diagonal, const std::vector<double>& below)
{
    const Eigen::Index n = Eigen::Index(diagonal.size());
    const Eigen::VectorXd d = Eigen::Map<const Eigen::VectorXd>(diagonal.data(), n);
    const Eigen::VectorXd b = Eigen::Map<const Eigen::VectorXd>(below.data(), n - 1);
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(d, b);
    return {solver.eigenvalues()[n - 1], below.back() * std::abs(solver.eigenvectors()(n - 1, n - 1))};
}

double largest_eigenvalue(Phase& phase)
{
    const State& s = phase.state();
    const int n = int(s.pos.size());
    std::vector<real> q(n, 0.0), before(n, 0.0), w(n, 0.0), scaled(n, 0.0), root_mass(s.inv_mass.size());
    root(root_mass, s.inv_mass);  // of the inverse masses
    const Planes start = vertex_planes(s.size, q);
    for (int v = 0; v < start.count; ++v)
        if (s.inv_mass[v] > 0) {
            const std::uint32_t first = 3 * std::uint32_t(v) + 1;
            start.set(v, {mixed(first), mixed(first + 1), mixed(first + 2)});
        }
    // w = M^-1/2 K M^-1/2 q
    const auto multiply = [&] {
        weigh(vertex_planes(s.size, scaled), root_mass, vertex_planes(s.size, std::as_const(q)));
        phase.linear().multiply(scaled.data(), w.data());
        weigh(vertex_planes(s.size, w), root_mass, vertex_planes(s.size, std::as_const(w)));
    };
    double length = std::sqrt(dot(q, q));
    std::vector<double> diagonal, below;
    Ritz ritz;
    while (length > 0 && int(diagonal.size()) < most_products) {
        divide(q, length);
        multiply();
        const double along = dot(q, w), last = below.empty() ? 0 : below.back();
        launch<lanczos_advance>(n, lanczos_args{q.data(), before.data(), w.data(), along, last});
        length = std::sqrt(dot(q, q));
        diagonal.push_back(along);
        below.push_back(length);
        const bool exhausted = length <= 1e-9 * std::abs(along);
        if (int(diagonal.size()) % products_between_looks != 0 && !exhausted) continue;
        ritz = largest_ritz(diagonal, below);
        if (exhausted || ritz.residual <= accuracy * ritz.value) break;
    }
    return ritz.value + ritz.residual;
}

}  // namespace

double highest_frequency(Phase& phase)
{
    phase.system().evaluate_stiffness(true, 0);
    phase.linear().assemble(phase.state(), 0, MatrixUse::products);
    return std::sqrt(std::max(0.0, largest_eigenvalue(phase)));
}

double largest_drag_rate(Phase& phase)
{
    const State& state = phase.state();
    if (!phase.system().dissipates()) return 0;
    phase.system().evaluate_drag();
    return launch_max<drag_rate>(state.size.vertex_count,
                                 drag_rate_args{state.vertex_stiffness.data(), state.inv_mass.data()});
}

}  // namespace selvage
