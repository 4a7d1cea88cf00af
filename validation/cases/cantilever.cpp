// A strip clamped at one end under its own weight: the heavy elastica of cantilever_master_curve.csv.
#include <cmath>

#include <fmt/format.h>

#include "validation/cases/cases.hpp"
#include "validation/measure/reference.hpp"
#include "validation/measure/specimen.hpp"

namespace selvage {
namespace {

constexpr double length = 0.1, areal_density = 0.15, gravity = 9.81;  // [m], [kg/m^2], [m/s^2]
constexpr double weight = areal_density * gravity;                    // [N/m^2]
constexpr double stretch = 2e4 * weight * length;                     // stretches by less than 1e-4 [N/m]

// Drop over reach of the middle of the free end.
double drop_over_reach(MeshFamily family, double gamma, int segments, Solve solve)
{
    const Cloth cloth = clamped_strip(family, length, 0.25 * length, segments);
    const double rigidity = weight * length * length * length / gamma;
    Specimen strip(cloth, isotropic_fabric(stretch, rigidity, 0, areal_density), heavy_plate(Vec3(0, 0, -gravity)),
                   solve);
    strip.balance_from_soft(solve == Solve::iterative ? 1e-5 : 1e-8);
    Vec3 tip = Vec3::Zero();
    int count = 0;
    for (int v = 0; v < int(cloth.positions.size()); ++v)
        if (cloth.positions[v].x() > length - 1e-9) {
            tip += strip.position(v);
            ++count;
        }
    tip /= count;
    return -tip.z() / tip.x();
}

double elastica(double gamma)
{
    for (const ReferenceRow& row : reference_table("cantilever_master_curve.csv"))
        if (std::abs(row.number("Gamma") / gamma - 1) < 1e-9) return row.number("H_over_W");
    return 0;
}

}  // namespace

void check_cantilever(CaseReport& report)
{
    report.from("cantilever_master_curve.csv: heavy elastica, two independent numerical solutions");
    for (const MeshFamily family : {MeshFamily::alternating, MeshFamily::equilateral, MeshFamily::irregular})
        for (const double gamma : {0.1, 1.0, 10.0, 100.0}) {
            const int segments = gamma > 5 ? 48 : 24;
            if (report.quick() && gamma > 50 && family != MeshFamily::alternating) continue;
            report.relative(fmt::format("H/W, Gamma {:g}, {}, n = {}", gamma, word_of(family), segments),
                            elastica(gamma), drop_over_reach(family, gamma, segments, Solve::direct),
                            gamma > 50 ? 0.01 : 0.005);
        }
    report.relative("H/W, Gamma 10, alternating, n = 24, conjugate gradients", elastica(10),
                    drop_over_reach(MeshFamily::alternating, 10, 24, Solve::iterative), 0.005);
    double error[3] = {};
    for (int i = 0; i < 3; ++i)
        error[i] = std::abs(drop_over_reach(MeshFamily::alternating, 10, 12 << i, Solve::direct) - elastica(10));
    report.from("convergence order of a second-order discretisation");
    report.absolute("order of H/W, Gamma 10, n = 12, 24", 2, std::log2(error[0] / error[1]), 0.4);
    report.absolute("order of H/W, Gamma 10, n = 24, 48", 2, std::log2(error[1] / error[2]), 0.4);
}

}  // namespace selvage
