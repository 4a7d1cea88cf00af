// Frequencies of small vibrations about equilibria: K q = omega^2 M q with the exact stiffness,
// oscillation_references.csv.
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "validation/cases/cases.hpp"
#include "validation/measure/reference.hpp"
#include "validation/measure/specimen.hpp"
#include "validation/measure/stiffness.hpp"

namespace selvage {
namespace {

// Returns the frequencies of the motion of the free vertices along z, in increasing order [rad/s].
std::vector<double> frequencies(Specimen& specimen)
{
    State& state = specimen.state();
    std::vector<int> free;
    for (int v = 0; v < state.size.vertex_count; ++v)
        if (state.inv_mass[v] > 0) free.push_back(3 * v + 2);
    Eigen::MatrixXd scaled = submatrix(exact_stiffness(state, specimen.params()), free);
    const int n = int(free.size());
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) scaled(i, j) /= std::sqrt(state.mass[free[i] / 3] * state.mass[free[j] / 3]);
    const Eigen::VectorXd squared =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (scaled + scaled.transpose()), Eigen::EigenvaluesOnly)
            .eigenvalues();
    std::vector<double> result;
    for (const double value : squared) result.push_back(std::sqrt(std::max(value, 0.0)));
    return result;
}

// A ribbon of 1 m that hangs along -x, pinned at its upper end.
Cloth ribbon(int count)
{
    Cloth cloth;
    for (const double y : {0.0, 0.1})
        for (int i = 0; i <= count; ++i) {
            cloth.positions.emplace_back(double(i) / count, y, 0);
            cloth.panel_coordinates.emplace_back(double(i) / count, y);
        }
    for (int i = 0; i < count; ++i) {
        cloth.faces.push_back({i, i + 1, count + i + 2});
        cloth.faces.push_back({i, count + i + 2, count + i + 1});
    }
    cloth.pinned = {0, count + 1};
    cloth.panels = {one_panel(cloth)};
    return cloth;
}

constexpr double gravity = 9.81;  // [m/s^2]

Params heavy_membrane()
{
    Params params = heavy_plate(Vec3(gravity, 0, 0));
    params.plate.scale = 0;
    return params;
}

// The hanging chain of N equal masses. Both edges of the ribbon are such a chain.
void chain(CaseReport& report, int count)
{
    constexpr double mass = 0.01;
    Specimen strip(ribbon(count), isotropic_fabric(1e7 * mass * gravity * count, 0, 0, 1), heavy_membrane(),
                   Solve::direct_in_plane);
    State& state = strip.state();
    for (int v = 0; v < state.size.vertex_count; ++v) {
        state.mass[v] = mass;
        if (state.inv_mass[v] > 0) state.inv_mass[v] = 1 / mass;
    }
    strip.balance(1e-6);
    const std::vector<double> measured = frequencies(strip);
    for (const ReferenceRow& row : reference_table("oscillation_references.csv")) {
        if (row.text("test") != "hanging_chain_discrete_N_equal_masses_L=1" ||
            row.text("key") != fmt::format("N={} omega_1..3", count))
            continue;
        std::istringstream values(row.text("value"));
        double expected = 0;
        for (int mode = 0; values >> expected; ++mode)
            report.relative(fmt::format("hanging chain of {} masses, omega_{} [rad/s]", count, mode + 1), expected,
                            measured[2 * mode], 1e-4);
    }
}

// The continuous heavy chain: the ribbon with the lumped masses of its cloth. Its two edges have different frequencies,
// because the vertex at the tip of one has a third of a link's mass and that of the other two thirds. The mean of the
// two frequencies is compared with the reference.
void continuous_chain(CaseReport& report)
{
    constexpr double areal_density = 0.2, width = 0.1;
    Specimen strip(ribbon(120), isotropic_fabric(1e7 * areal_density * width * gravity, 0, 0, areal_density),
                   heavy_membrane(), Solve::direct_in_plane);
    strip.balance(1e-5);
    const std::vector<double> measured = frequencies(strip);
    for (int mode = 1; mode <= 5; ++mode)
        report.relative(fmt::format("heavy ribbon of 1 m, omega_{} [rad/s]", mode),
                        oscillation_reference("hanging_chain_L=1", fmt::format("omega_{}", mode)),
                        0.5 * (measured[2 * mode - 2] + measured[2 * mode - 1]), 0.01);
}

// A square membrane that is stretched equally along both sides and pinned at its rim.
void drum(CaseReport& report, const std::string& stretch)
{
    constexpr int columns = 33;
    const double lambda = std::stod(stretch);
    Cloth cloth = flat_rectangle(MeshFamily::alternating, 1, 1, columns);
    for (int v = 0; v < int(cloth.positions.size()); ++v) {
        const Vec2& x = cloth.panel_coordinates[v];
        if (x.x() < 1e-9 || x.x() > 1 - 1e-9 || std::abs(x.y()) > 0.5 - 1e-9) cloth.pinned.push_back(v);
        cloth.positions[v] *= lambda;
    }
    Params params;
    params.membrane.scale = 1;
    Specimen sheet(cloth, isotropic_fabric(100, 0, 0, 0.15), params, Solve::direct_in_plane);
    const std::vector<double> measured = frequencies(sheet);
    // Modes 12 and 13 occur twice each, once for each side of the square.
    const std::pair<const char*, int> modes[] = {{"omega_11", 0}, {"omega_12", 1}, {"omega_22", 3}, {"omega_13", 4}};
    const std::string test = "membrane_square_StVK_Y100_nu0_sigma0.15_a0=1_lambda=" + stretch;
    for (const auto& [key, mode] : modes)
        report.relative(fmt::format("square membrane stretched by {}, {} [rad/s]", stretch, key),
                        oscillation_reference(test, key), measured[mode], 0.01);
}

// Bending modes of a clamped strip without gravity. With nu = 0 its only other modes are those of twisting.
void reed(CaseReport& report)
{
    constexpr double length = 0.1, rigidity = 1e-5, areal_density = 0.15;
    constexpr int segments = 60;
    const Cloth cloth = clamped_strip(MeshFamily::alternating, length, 0.1 * length, segments);
    Params params;
    params.plate.scale = 1;
    Specimen strip(cloth, isotropic_fabric(1, rigidity, 0, areal_density), params);
    const std::vector<double> measured = frequencies(strip);
    const double unit = std::sqrt(rigidity / areal_density) / (length * length);
    for (int mode = 1; mode <= 3; ++mode) {
        const double beta = oscillation_reference("clamped_free_strip", fmt::format("beta_{}", mode));
        double nearest = 0;
        for (const double omega : measured)
            if (std::abs(std::sqrt(omega / unit) - beta) < std::abs(nearest - beta)) nearest = std::sqrt(omega / unit);
        report.relative(fmt::format("clamped strip, omega_{} / sqrt(D / (sigma L^4))", mode), beta * beta,
                        nearest * nearest, 0.01);
    }
}

}  // namespace

void check_frequencies(CaseReport& report)
{
    report.from("oscillation_references.csv: zeros of Laguerre polynomials");
    for (const int count : {10, 50}) chain(report, count);
    report.from("oscillation_references.csv: zeros of Bessel's J0");
    continuous_chain(report);
    report.from("oscillation_references.csv: closed form of the stretched square");
    for (const char* stretch : {"1.01", "1.05", "1.1"}) drum(report, stretch);
    report.from("oscillation_references.csv: clamped-free beam");
    reed(report);
}

}  // namespace selvage
