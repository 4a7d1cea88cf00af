// Lateral buckling: the load at which a clamped strip on edge, with gravity along its width, tips over sideways. The
// strip is in equilibrium in its plane. Its out-of-plane stiffness is K + g K', with g the load, and it buckles at the
// load at which this matrix stops being positive definite.
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/SparseCholesky>

#include "validation/cases/cases.hpp"
#include "validation/measure/reference.hpp"
#include "validation/measure/specimen.hpp"
#include "validation/measure/stiffness.hpp"

namespace selvage {
namespace {

struct Strip {
    MeshFamily family;
    double width;  // over length
    int segments;
    double poisson;
    bool plate;
};

// A grid whose first two columns are pinned. Its squares have the same diagonals as the reference's, which is not the
// case for clamped_strip.
Cloth strip_on_edge(const Strip& strip)
{
    const double step = 1.0 / strip.segments;
    const int rows = std::max(2, int(std::lround(strip.width / step))) + 1;
    // The grid is first made of squares, so that rounding cannot change the number of rows, and is then scaled to the
    // width.
    Cloth cloth = flat_rectangle(strip.family, 1 + step, (rows - 1) * step, strip.segments + 2);
    for (int v = 0; v < int(cloth.positions.size()); ++v) {
        Vec3& x = cloth.positions[v];
        x.x() -= step;
        x.y() *= strip.width / ((rows - 1) * step);
        cloth.panel_coordinates[v] = x.head<2>();
        if (x.x() < 1e-9) cloth.pinned.push_back(v);
    }
    return cloth;
}

// Returns the lowest positive load at which bending + load * prestress has a negative eigenvalue, from the signs of the
// pivots of its LDL^T factorisation. The load is a multiple of the one that `prestress` was computed for.
double critical_load(const SparseMatrix& bending, const SparseMatrix& prestress)
{
    Eigen::SimplicialLDLT<SparseMatrix> factor;
    factor.analyzePattern(SparseMatrix(bending + prestress));
    const auto stable = [&](double load) {
        factor.factorize(SparseMatrix(bending + load * prestress));
        return factor.info() == Eigen::Success && factor.vectorD().minCoeff() > 0;
    };
    if (!stable(0)) throw std::runtime_error("the unloaded strip has no stiffness");
    double low = 0, high = 1;
    while (stable(high) && high < 1e12) {
        low = high;
        high *= 2;
    }
    for (int i = 0; i < 40; ++i) (stable(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
}

// Returns weight * L^3 / D at which the strip buckles; L = 1, D = 1.
double buckling_load(const Strip& strip)
{
    constexpr double unit_load = 1, stiffness = 1e6;  // [N/m^2], [N/m]: strains of 1e-6
    Params params = heavy_plate(Vec3(0, -unit_load, 0));
    params.plate.scale = strip.plate;
    params.bending.scale = !strip.plate;
    Specimen specimen(strip_on_edge(strip), isotropic_fabric(stiffness, 1, strip.poisson, 1), params,
                      Solve::direct_in_plane);
    std::vector<int> sideways;
    for (int v = 0; v < specimen.state().size.vertex_count; ++v)
        if (specimen.state().inv_mass[v] > 0) sideways.push_back(3 * v + 2);
    const SparseMatrix bending = submatrix(exact_stiffness(specimen.state(), specimen.params()), sideways);
    specimen.balance(1e-5);
    Params only_membrane;
    only_membrane.membrane.scale = 1;
    const SparseMatrix prestress = submatrix(exact_stiffness(specimen.state(), only_membrane), sideways);
    return unit_load * critical_load(bending, prestress);
}

// Returns the value that the table recommends, the lower of two upper bounds.
double thin_plate(double width, double poisson)
{
    for (const ReferenceRow& row : reference_table("lateral_buckling_thin_plate.csv"))
        if (std::abs(row.number("w_over_L") - width) < 1e-9 && std::abs(row.number("nu") - poisson) < 1e-6)
            return std::fmin(row.number("ritz"), row.number("bfs"));
    throw std::runtime_error("lateral_buckling_thin_plate.csv lacks a row");
}

}  // namespace

void check_buckling(CaseReport& report)
{
    report.from("lateral_buckling_thin_plate.csv: Ritz and C1 finite elements");
    for (const double poisson : {0.0, 0.35})
        for (const double width : {0.1, 0.5, 0.9}) {
            const int segments = width < 0.2 ? 80 : 40;
            report.relative(
                fmt::format("plate, nu {:g}, w/L {:g}, alternating, n = {}: w L^3 / D", poisson, width, segments),
                thin_plate(width, poisson), buckling_load({MeshFamily::alternating, width, segments, poisson, true}),
                0.03);
        }
    for (const MeshFamily family : {MeshFamily::same_diagonal, MeshFamily::cross})
        report.relative(fmt::format("plate, nu 0.35, w/L 0.5, {}, n = 40: w L^3 / D", word_of(family)),
                        thin_plate(0.5, 0.35), buckling_load({family, 0.5, 40, 0.35, true}), 0.03);
    report.from("lateral_hinge_discrete.csv: linear buckling of the same mesh of plain hinges");
    const std::pair<MeshFamily, const char*> names[] = {{MeshFamily::alternating, "grid_alternating"},
                                                        {MeshFamily::same_diagonal, "grid_same_diagonal"},
                                                        {MeshFamily::cross, "cross4"}};
    for (const auto& [family, mesh] : names)
        for (const ReferenceRow& row : reference_table("lateral_hinge_discrete.csv")) {
            const double width = row.number("w_over_L");
            if (row.text("mesh") != mesh || (width != 0.1 && width != 0.5 && width != 0.9)) continue;
            report.relative(fmt::format("hinge, w/L {:g}, {}, n = 40: w L^3 / k", width, word_of(family)),
                            row.number("discrete_n40"), buckling_load({family, width, 40, 0, false}), 0.02);
        }
}

}  // namespace selvage
