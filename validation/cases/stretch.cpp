// Patch tests of the membrane: uniform strains on an irregular mesh, stretch_patch_tests.csv.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "validation/cases/cases.hpp"
#include "validation/measure/reference.hpp"
#include "validation/measure/specimen.hpp"

namespace selvage {
namespace {

constexpr double width = 0.6, height = 0.4, stiffness = 100;  // [m], [m], [N/m]

Mat2 matrix(const ReferenceRow& row, const std::string& name)
{
    Mat2 m;
    m << row.number(name + "11"), row.number(name + "12"), row.number(name + "21"), row.number(name + "22");
    return m;
}

// Returns the fabric of a material model of the table.
Fabric fabric_of(const ReferenceRow& row)
{
    if (row.text("model") == "stvk") return isotropic_fabric(stiffness, 0, row.number("nu"), 1);
    Fabric fabric = isotropic_fabric(stiffness, 0, 0, 1);
    fabric.stretch_weft_curve = cubic_curve(50, 800, 0);
    fabric.stretch_warp_curve = cubic_curve(100, 2000, 5000);
    fabric.shear_curve = cubic_curve(5, 0, 300);
    return fabric;
}

struct Mismatch {
    double force = 0, energy = 0;  // relative
};

// Returns the vertices of the edge on which x (axis 0) or y (axis 1) is largest.
std::vector<int> far_edge(const Cloth& cloth, int axis)
{
    std::vector<int> edge;
    for (int v = 0; v < int(cloth.positions.size()); ++v)
        if (cloth.panel_coordinates[v][axis] > (axis == 0 ? width : 0.5 * height) - 1e-9) edge.push_back(v);
    return edge;
}

bool on_rim(const Vec2& x, bool ends_only)
{
    const bool end = x.x() < 1e-9 || x.x() > width - 1e-9;
    return end || (!ends_only && std::abs(x.y()) > 0.5 * height - 1e-9);
}

// Pins the rim (or two of its sides) at the strained positions and moves all other vertices to equilibrium.
Mismatch patch(const ReferenceRow& row, const Fabric& fabric)
{
    const Mat2 strain = matrix(row, "F"), stress = matrix(row, "P");
    const bool free_sides = row.text("case") == "uniaxial_free";
    Cloth cloth = flat_rectangle(MeshFamily::irregular, width, height, 13);
    for (int v = 0; v < int(cloth.positions.size()); ++v) {
        const Vec2 x = strain * cloth.panel_coordinates[v];
        const bool held = on_rim(cloth.panel_coordinates[v], free_sides);
        if (held) cloth.pinned.push_back(v);
        cloth.positions[v] = Vec3(x.x() + (held ? 0 : 1e-3 * std::sin(7.0 * v)), x.y(), 0);
    }
    Params params;
    (has_curves(fabric) ? params.curved_membrane.scale : params.membrane.scale) = 1;
    Specimen sheet(cloth, fabric, params, Solve::direct_in_plane);
    sheet.balance(1e-11);
    Mismatch mismatch;
    const double area = width * height, energy = row.number("W") * area;
    mismatch.energy = std::abs(sheet.system().potential_energy() - energy) / energy;
    for (const int axis : {0, 1}) {
        const double side = axis == 0 ? height : width;
        Vec3 total = Vec3::Zero();
        for (const int v : far_edge(cloth, axis)) total += sheet.holding_force(v);
        // A free side carries no load; its corners belong to the pinned sides.
        if (axis == 1 && free_sides) continue;
        const Vec2 expected = side * stress.col(axis);
        mismatch.force = std::max(mismatch.force, (total.head<2>() - expected).norm() / (side * stress.norm()));
    }
    return mismatch;
}

}  // namespace

void check_stretch(CaseReport& report)
{
    report.from("stretch_patch_tests.csv: closed forms, 30 digits");
    struct Worst {
        Mismatch mismatch;
        int count = 0;
    };
    std::map<std::string, Worst> worst;
    for (const ReferenceRow& row : reference_table("stretch_patch_tests.csv")) {
        const std::string poisson = row.text("model") == "stvk" ? fmt::format(", nu {:g}", row.number("nu")) : "";
        Worst& at = worst[fmt::format("{}{}, {}", row.text("model"), poisson, row.text("case"))];
        const Mismatch mismatch = patch(row, fabric_of(row));
        at.mismatch.force = std::max(at.mismatch.force, mismatch.force);
        at.mismatch.energy = std::max(at.mismatch.energy, mismatch.energy);
        ++at.count;
    }
    for (const auto& [name, at] : worst) {
        report.absolute(fmt::format("{}: edge force, worst of {} strains, relative", name, at.count), 0,
                        at.mismatch.force, 1e-10);
        report.absolute(fmt::format("{}: energy, worst of {} strains, relative", name, at.count), 0, at.mismatch.energy,
                        1e-10);
    }
}

}  // namespace selvage
