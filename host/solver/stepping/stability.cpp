#include "host/solver/stepping/stability.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Eigenvalues>

#include "host/parallel/launch.hpp"

namespace selvage {
namespace {

constexpr int most_products = 80;
constexpr int products_between_looks = 10;
constexpr double accuracy = 0.02;  // of the eigenvalue, so half of it for the frequency

double dot(const std::vector<real>& a, const std::vector<real>& b)
{
    return sum_items(int(a.size()), [x = a.data(), y = b.data()](int i) { return x[i] * y[i]; });
}

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

// w = M^-1/2 K M^-1/2 q
void scaled_product(Phase& phase, const std::vector<real>& q, std::vector<real>& scaled, std::vector<real>& w)
{
    const State& s = phase.state();
    const int vs = s.size.vertex_stride;
    const auto scale = [&s, vs](const std::vector<real>& from, std::vector<real>& to) {
        for_each_item(s.size.vertex_count, [&, vs](int v) {
            for (int c = 0; c < 3; ++c) to[c * vs + v] = std::sqrt(s.inv_mass[v]) * from[c * vs + v];
        });
    };
    scale(q, scaled);
    phase.linear().multiply(scaled.data(), w.data());
    scale(w, w);
}

double largest_eigenvalue(Phase& phase)
{
    const State& s = phase.state();
    const int n = int(s.pos.size()), vs = s.size.vertex_stride;
    std::vector<real> q(n, 0.0), before(n, 0.0), w(n, 0.0), scaled(n, 0.0);
    for (int c = 0; c < 3; ++c)
        for (int v = 0; v < s.size.vertex_count; ++v)
            if (s.inv_mass[v] > 0) q[c * vs + v] = mixed(std::uint32_t(3 * v + c) + 1);
    double length = std::sqrt(dot(q, q));
    std::vector<double> diagonal, below;
    Ritz ritz;
    while (length > 0 && int(diagonal.size()) < most_products) {
        for_each_item(n, [&, length](int i) { q[i] /= length; });
        scaled_product(phase, q, scaled, w);
        const double along = dot(q, w), last = below.empty() ? 0 : below.back();
        for_each_item(n, [&, along, last](int i) {
            const real next = w[i] - along * q[i] - last * before[i];
            before[i] = q[i];
            q[i] = next;
        });
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
    State& state = phase.state();
    phase.newton().terms().evaluate_stiffness(true, 0);
    phase.linear().assemble(state, 0, false);
    return std::sqrt(std::max(0.0, largest_eigenvalue(phase)));
}

double largest_drag_rate(Phase& phase)
{
    State& state = phase.state();
    ActiveTerms& terms = phase.newton().terms();
    if (!terms.dissipates()) return 0;
    terms.evaluate_drag();
    return max_items(state.size.vertex_count, [&state](int v) {
        double widest = 0;
        for (int row = 0; row < 3; ++row) {
            double sum = 0;
            for (int c = 0; c < 3; ++c) sum += std::abs(double(state.vertex_stiffness[9 * v + 3 * row + c]));
            widest = std::max(widest, sum);
        }
        return widest * state.inv_mass[v];
    });
}

}  // namespace selvage
