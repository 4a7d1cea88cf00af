#include "host/garment/pins.hpp"
#include "host/garment/sheet.hpp"
#include "host/model/prolongation.hpp"
#include "host/run/progressive.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

Cloth sheet_of(int resolution)
{
    SheetScene sheet;
    sheet.resolution = resolution;
    sheet.mesh_family = MeshFamily::same_diagonal;
    Cloth cloth = make_sheet(sheet, "test", "sheet[0]");
    hold_vertices(cloth, chosen_vertices(cloth, {"", PinGroup::top_corners, ""}, {}));
    return cloth;
}

std::array<double, 2> stretch_range(const Cloth& cloth, const std::vector<Vec3>& positions)
{
    std::array<double, 2> range{1e30, 0};
    for (const Face& face : cloth.faces)
        for (int k = 0; k < 3; ++k) {
            const int a = face[k], b = face[(k + 1) % 3];
            const double stretch =
                (positions[a] - positions[b]).norm() / (cloth.panel_coordinates[a] - cloth.panel_coordinates[b]).norm();
            range = {std::min(range[0], stretch), std::max(range[1], stretch)};
        }
    return range;
}

}  // namespace

TEST_CASE("a shape that is interpolated to a nested mesh keeps its range of edge stretches, and pinned vertices stay")
{
    const Cloth coarse = sheet_of(9), fine = sheet_of(17);
    std::vector<Vec3> wave;
    for (const Vec2& u : coarse.panel_coordinates)
        wave.push_back(Vec3(u.x(), u.y(), 1 + 0.2 * std::sin(6 * u.x()) * u.y()));
    for (int v : coarse.pinned) wave[std::size_t(v)] = coarse.positions[std::size_t(v)];
    const std::vector<Vec3> carried = carry_over(fine, make_prolongation(coarse, fine), wave);
    const auto before = stretch_range(coarse, wave), after = stretch_range(fine, carried);
    CHECK(before[1] > 1.05);
    CHECK(after[0] == Approx(before[0]).epsilon(1e-12));
    CHECK(after[1] == Approx(before[1]).epsilon(1e-12));
    REQUIRE(fine.pinned.size() == 2);
    for (int v : fine.pinned) CHECK(carried[std::size_t(v)] == fine.positions[std::size_t(v)]);
}
