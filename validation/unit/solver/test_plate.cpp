#include "host/garment/sheet.hpp"
#include "host/model/cloth_model.hpp"
#include "host/solver/state/plate.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "validation/measure/small_cloth.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

constexpr double curvature = 1e-3;  // small enough for the linear theory of flat plates [1/m]

FabricTable one_rigidity(double weft, double warp)
{
    Fabric fabric;
    fabric.name = "test";
    fabric.bending_weft = weft;
    fabric.bending_warp = warp;
    return {{"test", fabric}};
}

Cloth rectangle(MeshFamily family)
{
    SheetScene sheet;
    sheet.width = 1.2;
    sheet.height = 0.9;
    sheet.resolution = 13;
    sheet.mesh_family = family;
    sheet.fabric = "test";
    return make_sheet(sheet, "", "sheet[0]");
}

// Returns the positions of the sheet bent to a cylinder along x (axis 0) or y (axis 1) of its start positions.
std::vector<Vec3> cylinder(const Cloth& cloth, int axis)
{
    std::vector<Vec3> positions = cloth.positions;
    for (Vec3& x : positions) x.z() = 0.5 * curvature * x[axis] * x[axis];
    return positions;
}

double plate_energy(const Cloth& cloth, const FabricTable& fabrics, const std::vector<Vec3>& positions)
{
    Params params;
    params.plate.scale = 1;
    State state = make_state(make_topology(cloth, true), cloth, fabrics, params, positions, {});
    for (const Term& term : all_terms())
        if (term.name == "plate") return term.energy(state, params);
    return 0;
}

// Returns the area of the faces without an edge on the free ends; faces at the free ends carry no moment.
double bent_area(const Cloth& cloth, int axis)
{
    double low = 1e9, high = -1e9, total = 0;
    for (const Vec3& x : cloth.positions) {
        low = std::min(low, x[axis]);
        high = std::max(high, x[axis]);
    }
    for (const Face& f : cloth.faces) {
        int at_low = 0, at_high = 0;
        for (int v : f) {
            at_low += cloth.positions[v][axis] < low + 1e-9;
            at_high += cloth.positions[v][axis] > high - 1e-9;
        }
        const Vec3 normal =
            (cloth.positions[f[1]] - cloth.positions[f[0]]).cross(cloth.positions[f[2]] - cloth.positions[f[0]]);
        if (at_low < 2 && at_high < 2) total += 0.5 * normal.norm();
    }
    return total;
}

// Cuts a grid between two columns into two panels that are sewn together there. The panel coordinates of the second one
// are rotated by `angle`, and mirrored if `turned_over`.
Cloth sewn_grid(int columns, int rows, int cut, double angle, bool turned_over)
{
    const Cloth whole = grid_cloth(columns, rows);
    Cloth cloth;
    ClothPanel panel = whole.panels[0];
    const Eigen::Rotation2Dd turn(angle);
    for (int side = 0; side < 2; ++side) {
        panel.first_vertex = int(cloth.positions.size());
        panel.first_face = int(cloth.faces.size());
        std::vector<int> number(whole.positions.size(), -1);
        for (int v = 0; v < int(whole.positions.size()); ++v) {
            if (side == 0 ? v % columns > cut : v % columns < cut) continue;
            number[v] = int(cloth.positions.size());
            cloth.positions.push_back(whole.positions[v]);
            Vec2 x = whole.panel_coordinates[v];
            if (side == 1 && turned_over) x.x() = -x.x();
            cloth.panel_coordinates.push_back(side == 1 ? Vec2(turn * x) : x);
        }
        for (Face f : whole.faces) {
            if (number[f[0]] < 0 || number[f[1]] < 0 || number[f[2]] < 0) continue;
            if (side == 1 && turned_over) std::swap(f[1], f[2]);
            cloth.faces.push_back({number[f[0]], number[f[1]], number[f[2]]});
        }
        panel.vertex_count = int(cloth.positions.size()) - panel.first_vertex;
        panel.face_count = int(cloth.faces.size()) - panel.first_face;
        cloth.panels.push_back(panel);
    }
    for (int r = 0; r < rows; ++r) {
        const int first = r * (cut + 1) + cut;
        const int second = cloth.panels[1].first_vertex + r * (columns - cut);
        cloth.seam_pairs.push_back({first, second});
    }
    return cloth;
}

}  // namespace

TEST_CASE("a plate bent along weft or warp has exactly the fabric's rigidity on any mesh", "[plate]")
{
    const FabricTable fabrics = one_rigidity(0.02, 0.005);
    for (const MeshFamily family : {MeshFamily::alternating, MeshFamily::same_diagonal, MeshFamily::irregular})
        for (int axis : {0, 1}) {
            INFO(word_of(family) << " axis " << axis);
            const Cloth cloth = rectangle(family);
            const double rigidity = axis == 0 ? 0.02 : 0.005;
            CHECK(plate_energy(cloth, fabrics, cylinder(cloth, axis)) ==
                  Approx(0.5 * rigidity * curvature * curvature * bent_area(cloth, axis)).epsilon(1e-5));
        }
}

TEST_CASE("the rigidity of an isotropic plate does not depend on the direction of its mesh", "[plate]")
{
    const FabricTable fabrics = one_rigidity(0.02, 0.02);
    for (const MeshFamily family : {MeshFamily::alternating, MeshFamily::same_diagonal, MeshFamily::irregular})
        for (double angle : {0.3, 0.785, 1.2}) {
            INFO(word_of(family) << " angle " << angle);
            Cloth cloth = rectangle(family);
            const double straight = plate_energy(cloth, fabrics, cylinder(cloth, 0));
            const Eigen::Rotation2Dd turn(angle);
            for (Vec2& x : cloth.panel_coordinates) x = turn * x;
            CHECK(plate_energy(cloth, fabrics, cylinder(cloth, 0)) == Approx(straight).epsilon(1e-5));
        }
}

TEST_CASE("a seam between panels of one fabric bends like the fabric, whatever the panels' coordinates", "[plate]")
{
    const FabricTable fabrics = one_rigidity(0.02, 0.02);
    const Cloth whole = grid_cloth(11, 8);
    const double expected = plate_energy(whole, fabrics, cylinder(whole, 0));
    CHECK(expected == Approx(0.5 * 0.02 * curvature * curvature * bent_area(whole, 0)).epsilon(1e-5));
    for (bool turned_over : {false, true})
        for (double angle : {0.0, 1.1}) {
            INFO("turned over " << turned_over << " angle " << angle);
            const Cloth sewn = sewn_grid(11, 8, 5, angle, turned_over);
            CHECK(plate_energy(sewn, fabrics, cylinder(sewn, 0)) == Approx(expected).epsilon(1e-5));
        }
}

TEST_CASE("a plate next to pinned vertices bends from the clamp on, with its full rigidity", "[plate]")
{
    const FabricTable fabrics = one_rigidity(0.02, 0.02);
    Cloth cloth = grid_cloth(11, 8);
    for (int v = 0; v < int(cloth.positions.size()); ++v)
        if (v % 11 < 2) cloth.pinned.push_back(v);
    std::vector<Vec3> positions = cloth.positions;
    for (Vec3& x : positions) {
        const double way = std::max(x.x() - 0.1, 0.0);  // the second column is where the clamp ends
        x.z() = 0.5 * curvature * way * way;
    }
    const double free_area = 0.7 * 0.9, end_area = 0.5 * 0.7 * 0.1;
    CHECK(plate_energy(cloth, fabrics, positions) ==
          Approx(0.5 * 0.02 * curvature * curvature * (free_area - end_area)).epsilon(1e-5));
}
