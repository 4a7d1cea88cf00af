// The effective bending rigidity of meshes: sheets bent to cylinders of small curvature, whose inner vertices are free
// to move to equilibrium, and strips under small loads.
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/SparseCholesky>

#include "host/mesh/sheet_families.hpp"
#include "kernels/hinge.h"
#include "validation/cases/cases.hpp"
#include "validation/measure/reference.hpp"
#include "validation/measure/specimen.hpp"
#include "validation/measure/stiffness.hpp"

namespace selvage {
namespace {

constexpr double directions[] = {0, 22.5, 45, 67.5, 90};  // [degrees]
constexpr int columns = 48, window = 24, band = 4;  // cells: of the sheet, of the measured window, pinned at the rim
constexpr double curvature = 1e-3;                  // small enough for the theory of flat plates [1/m]

double row_height(MeshFamily family)
{
    return (family == MeshFamily::equilateral ? 0.5 * std::numbers::sqrt3 : 1.0) / columns;
}

// Returns the energy of the hinges whose middle lies in the window. The window spans whole periods of the regular mesh
// families.
double window_energy(const State& s, const std::vector<Vec2>& rest, double row)
{
    const int hs = s.size.hinge_stride;
    const auto turn = [&](int h) { return 2 * hinge_at(h, s.size, s.pos.data(), s.hinge_vertex.data()).sine; };
    double total = 0;
    for (int h = 0; h < s.size.hinge_count; ++h) {
        const Vec2 middle = 0.5 * (rest[s.hinge_vertex[h]] + rest[s.hinge_vertex[hs + h]]);
        const double i = middle.x() * columns - 0.1 - (columns - window) / 2;
        const double j = middle.y() / row - 0.1 + window / 2;
        if (i < 0 || i >= window || j < 0 || j >= window) continue;
        double moment = 0;
        if (s.coupling_slots.empty())
            moment = s.hinge_rigidity[h] * turn(h);
        else
            for (int k = s.coupling_slots[h]; k < s.coupling_slots[hs + h]; ++k)
                moment += s.coupling_rigidity[k] * turn(s.coupling_hinge[k]);
        total += 0.5 * moment * turn(h);
    }
    return total;
}

// Moves the inner vertices to the minimum of the energy.
void relax_inside(Specimen& sheet, const std::vector<Vec2>& rest, double row)
{
    const SparseMatrix whole = exact_stiffness(sheet.state(), sheet.params());
    std::vector<int> inside;
    const auto is_inside = [&](const Vec2& x) {
        const double i = x.x() * columns, j = x.y() / row + columns / 2;
        return std::min({i, columns - i, j, columns - j}) > band - 0.5;
    };
    for (int v = 0; v < int(rest.size()); ++v)
        if (is_inside(rest[v])) inside.push_back(3 * v + 2);
    Eigen::VectorXd height = Eigen::VectorXd::Zero(whole.cols());
    for (int v = 0; v < int(rest.size()); ++v) height[3 * v + 2] = sheet.position(v).z();
    const Eigen::VectorXd load = whole * height;
    Eigen::VectorXd rhs(inside.size());
    for (int i = 0; i < int(inside.size()); ++i) rhs[i] = load[inside[i]];
    const Eigen::SimplicialLDLT<SparseMatrix> factor(submatrix(whole, inside));
    if (factor.info() != Eigen::Success) throw std::runtime_error("the bending stiffness is singular");
    const Eigen::VectorXd change = factor.solve(rhs);
    for (int i = 0; i < int(inside.size()); ++i) {
        const int v = inside[i] / 3;
        sheet.place(v, sheet.position(v) - Vec3(0, 0, change[i]));
    }
}

// Returns the effective rigidity D of a sheet bent to a cylinder whose curved direction makes this angle with weft. The
// fabric's D is 1.
double shown_rigidity(MeshFamily family, double angle, bool plate)
{
    const double row = row_height(family);
    const Cloth cloth = flat_rectangle(family, 1, columns * row, columns + 1);
    Params params;
    (plate ? params.plate.scale : params.bending.scale) = 1;
    Specimen sheet(cloth, isotropic_fabric(1, 1, 0, 1), params);
    const Vec2 along(std::cos(angle * std::numbers::pi / 180), std::sin(angle * std::numbers::pi / 180));
    std::vector<double> height;
    for (const Vec2& x : cloth.panel_coordinates) height.push_back(0.5 * curvature * std::pow(along.dot(x), 2));
    for (int v = 0; v < int(height.size()); ++v) sheet.place(v, sheet.position(v) + Vec3(0, 0, height[v]));
    relax_inside(sheet, cloth.panel_coordinates, row);
    const double area = double(window) * window * row / columns;
    return 2 * window_energy(sheet.state(), cloth.panel_coordinates, row) / (area * curvature * curvature);
}

double hinge_rigidity(const std::string& mesh, double angle)
{
    for (const ReferenceRow& row : reference_table("hinge_effective_bending.csv")) {
        if (row.text("mesh") != mesh) continue;
        const double c = std::cos(angle * std::numbers::pi / 180), s = std::sin(angle * std::numbers::pi / 180);
        const double xx = c * c, yy = s * s, xy = c * s;
        return row.number("Cxx") * xx * xx + row.number("Cyy") * yy * yy + row.number("Cs") * xy * xy +
               2 * (row.number("C12") * xx * yy + row.number("C1s") * xx * xy + row.number("C2s") * yy * xy);
    }
    throw std::runtime_error("hinge_effective_bending.csv has no mesh " + mesh);
}

// Returns the drop of the free end divided by w L^4 / (8 D), under a load so small that linear beam theory holds.
double tip_drop(MeshFamily family)
{
    constexpr double length = 0.1, weight = 9.81 * 0.15, gamma = 0.01,
                     rigidity = weight * length * length * length / gamma;
    const Cloth cloth = clamped_strip(family, length, 0.25 * length, 24);
    Specimen strip(cloth, isotropic_fabric(2e4 * weight * length, rigidity, 0, 0.15), heavy_plate(Vec3(0, 0, -9.81)));
    strip.balance(1e-8);
    double drop = 0;
    int count = 0;
    for (int v = 0; v < int(cloth.positions.size()); ++v)
        if (cloth.positions[v].x() > length - 1e-9) {
            drop -= strip.position(v).z();
            ++count;
        }
    return drop / count / (length * gamma / 8);
}

}  // namespace

void check_rigidity(CaseReport& report)
{
    report.from("the fabric's own rigidity");
    for (MeshFamily family : rectangle_families())
        for (const double angle : directions)
            report.relative(fmt::format("plate, {}, {:g} degrees, D shown / D", word_of(family), angle), 1,
                            shown_rigidity(family, angle, true), 0.02);
    report.from("cantilever under small load: w L^4 / (8 D)");
    for (MeshFamily family : rectangle_families())
        report.relative(fmt::format("plate, {}, tip of a strip / (w L^4 / 8 D)", word_of(family)), 1, tip_drop(family),
                        0.02);
    report.from("hinge_effective_bending.csv: periodic homogenisation of plain hinges");
    const std::pair<MeshFamily, const char*> names[] = {{MeshFamily::equilateral, "equilateral"},
                                                        {MeshFamily::same_diagonal, "grid_same_diagonal"},
                                                        {MeshFamily::alternating, "grid_alternating"},
                                                        {MeshFamily::rows, "grid_rows"},
                                                        {MeshFamily::cross, "cross4"}};
    for (const auto& [family, mesh] : names)
        for (const double angle : {0.0, 22.5, 45.0})
            report.relative(fmt::format("hinge, {}, {:g} degrees, D shown / D", word_of(family), angle),
                            hinge_rigidity(mesh, angle), shown_rigidity(family, angle, false), 0.02);
    report.from("random_delaunay of hinge_effective_bending.csv, a similar mesh");
    report.inform("hinge, irregular, 0 degrees, D shown / D", hinge_rigidity("random_delaunay", 0),
                  shown_rigidity(MeshFamily::irregular, 0, false));
}

}  // namespace selvage
