// Plain sheets of cloth: their meshes, pins and prolongations between resolutions.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/garment/outline.hpp"
#include "host/garment/sheet.hpp"
#include "host/mesh/sheet_families.hpp"
#include "host/model/prolongation.hpp"
#include "io/errors.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

double face_area(const Cloth& cloth, const Face& face)
{
    const std::vector<Vec2>& points = cloth.panel_coordinates;
    return signed_area({points[face[0]], points[face[1]], points[face[2]]});
}

}  // namespace

TEST_CASE("sheets have the vertices, size and place that their scene says")
{
    SheetScene sheet;
    sheet.resolution = 9;
    sheet.width = 0.8;
    sheet.height = 0.4;
    sheet.rotation = Vec3(90, 0, 0);
    for (const MeshFamily family : {MeshFamily::alternating, MeshFamily::same_diagonal, MeshFamily::irregular}) {
        sheet.mesh_family = family;
        const Cloth cloth = make_sheet(sheet, "scene.toml", "sheet[0]");
        CHECK(cloth.positions.size() == 45);
        CHECK(cloth.faces.size() == 64);
        CHECK(cloth.panels[0].rest_area == Approx(0.32));
        CHECK(cloth.panels[0].rest_boundary == Approx(2.4));
        for (const Face& face : cloth.faces) CHECK(face_area(cloth, face) > 0);
        CHECK((cloth.positions[0] - Vec3(-0.4, 0, 0.8)).norm() < 1e-12);
        CHECK((cloth.positions[44] - Vec3(0.4, 0, 1.2)).norm() < 1e-12);
    }
    sheet.shape = SheetShape::disc;
    sheet.radius = 0.15;
    sheet.resolution = 31;
    const Cloth disc = make_sheet(sheet, "scene.toml", "sheet[0]");
    CHECK(disc.panels[0].rest_area == Approx(std::numbers::pi * 0.15 * 0.15).epsilon(0.005));
    for (const Face& face : disc.faces) CHECK(face_area(disc, face) > 0.1 * 0.01 * 0.01);
    sheet.shape = SheetShape::mesh;
    CHECK_THROWS_WITH(make_sheet(sheet, "scene.toml", "sheet[0]"), contains_text("sheet[0].shape"));
}

TEST_CASE("every mesh family fills its rectangle or disc with faces that look up")
{
    SheetScene sheet;
    sheet.resolution = 10;
    sheet.width = 0.8;
    sheet.height = 0.4;
    for (const MeshFamily family : rectangle_families()) {
        INFO(word_of(family));
        sheet.mesh_family = family;
        const Cloth cloth = make_sheet(sheet, "scene.toml", "sheet[0]");
        CHECK(cloth.panels[0].rest_area == Approx(0.32));
        CHECK(cloth.panels[0].rest_boundary == Approx(2.4));
        for (const Face& face : cloth.faces) CHECK(face_area(cloth, face) > 0);
    }
    sheet.shape = SheetShape::disc;
    sheet.radius = 0.15;
    sheet.resolution = 21;
    for (const MeshFamily family : disc_families()) {
        INFO(word_of(family));
        sheet.mesh_family = family;
        const Cloth cloth = make_sheet(sheet, "scene.toml", "sheet[0]");
        CHECK(cloth.panels[0].rest_area == Approx(std::numbers::pi * 0.15 * 0.15).epsilon(0.01));
        for (const Face& face : cloth.faces) CHECK(face_area(cloth, face) > 0);
    }
    sheet.mesh_family = MeshFamily::cross;
    CHECK_THROWS_WITH(make_sheet(sheet, "scene.toml", "sheet[0]"), contains_text("sheet[0].mesh_family"));
}

TEST_CASE("a sheet from a mesh takes its rest shape from texture coordinates, or its own plane if it is flat")
{
    LoadedSheet loaded;
    loaded.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 0, 2}, {0, 0, 2}};
    loaded.mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    SheetScene sheet;
    const auto made = [&](const std::optional<Vec3>& center) {
        return sheet_from_mesh(loaded, sheet, center, "scene.toml", "sheet[1]");
    };
    CHECK(made({}).positions == loaded.mesh.vertices);
    const Cloth flat = made(Vec3(5, 5, 5));
    CHECK(flat.panels[0].rest_area == Approx(2));
    CHECK((flat.positions[0] - Vec3(4.5, 5, 4)).norm() < 1e-12);
    for (const Face& face : flat.faces) CHECK(face_area(flat, face) == Approx(1));
    sheet.rotation = Vec3(0, 180, 0);
    CHECK((made({}).positions[0] - Vec3(1, 0, 2)).norm() < 1e-12);

    loaded.mesh.vertices[2].y() = 0.3;
    CHECK_THROWS_WITH(made({}), contains_text("sheet[1].mesh"));
    loaded.rest = {{0, 0}, {-1, 0}, {-1, 2}, {0, 2}};  // seen from behind
    const Cloth textured = made({});
    CHECK(textured.panels[0].rest_area == Approx(2));
    CHECK(textured.panels[0].rest_boundary == Approx(6));
    loaded.rest = {{0, 0}, {1, 0}, {1, 2}, {2, 0}};
    loaded.file = "folded.obj";
    loaded.face_lines = {5, 6};
    CHECK_THROWS_WITH(made({}), contains_text("folded.obj:5") && contains_text("turned over"));
}

TEST_CASE("a prolongation between sheets of different resolution reproduces linear functions")
{
    SheetScene sheet;
    sheet.resolution = 5;
    sheet.mesh_family = MeshFamily::irregular;
    const Cloth coarse = make_sheet(sheet, "scene.toml", "sheet[0]");
    sheet.resolution = 18;
    const Cloth fine = make_sheet(sheet, "scene.toml", "sheet[0]");
    std::vector<double> values;
    for (const Vec2& point : coarse.panel_coordinates) values.push_back(point.x() + 2 * point.y());
    const Prolongation prolongation = make_prolongation(coarse, fine);
    for (std::size_t i = 0; i < fine.positions.size(); ++i) {
        double sum = 0;
        for (int k = prolongation.offset[i]; k < prolongation.offset[i + 1]; ++k)
            sum += prolongation.weight[k] * values[prolongation.column[k]];
        CHECK(sum == Approx(fine.panel_coordinates[i].x() + 2 * fine.panel_coordinates[i].y()).margin(1e-9));
    }
}
