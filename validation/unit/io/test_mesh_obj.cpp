#include <chrono>
#include <cmath>

#include "io/errors.hpp"
#include "io/file_text.hpp"
#include "io/mesh/body_mesh.hpp"
#include "io/mesh/mesh_obj.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;

namespace {

constexpr const char* cube = R"(# a cube of quads
mtllib none.mtl
o box
v 0 0 0
v 1 0 0 1.0 0.5 0.5
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
vn 0 0 1
g low
f 4//1 3//1 2//1 1//1
g sides
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
g high
usemtl white
f -4 -3 -2 -1
)";

TriangleMesh read_text(const std::string& text, LengthUnit unit = LengthUnit::m, Axis up = Axis::z,
                       std::vector<Vec2>* texture = nullptr)
{
    const ScratchFolder folder;
    return read_obj(folder.write("mesh.obj", text), unit, up, texture);
}

// A sphere of latitude rings with as many triangles as a scanned body.
TriangleMesh round_body(int rings, int sectors)
{
    TriangleMesh mesh;
    mesh.vertices.emplace_back(0, 0, 1);
    for (int ring = 1; ring < rings; ++ring)
        for (int sector = 0; sector < sectors; ++sector) {
            const double polar = 3.14159265358979 * ring / rings, turn = 2 * 3.14159265358979 * sector / sectors;
            const double width = std::sin(polar);
            mesh.vertices.emplace_back(width * std::cos(turn), width * std::sin(turn), std::cos(polar));
        }
    mesh.vertices.emplace_back(0, 0, -1);
    const auto at = [&](int ring, int sector) { return 1 + (ring - 1) * sectors + sector % sectors; };
    const int south = int(mesh.vertices.size()) - 1;
    for (int sector = 0; sector < sectors; ++sector) {
        mesh.faces.push_back({0, at(1, sector), at(1, sector + 1)});
        mesh.faces.push_back({south, at(rings - 1, sector + 1), at(rings - 1, sector)});
        for (int ring = 1; ring + 1 < rings; ++ring) {
            mesh.faces.push_back({at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1)});
            mesh.faces.push_back({at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1)});
        }
    }
    return mesh;
}

}  // namespace

TEST_CASE("polygons, negative indices, normals and groups of an OBJ file are read")
{
    const TriangleMesh mesh = read_text(cube);
    REQUIRE(mesh.vertices.size() == 8);
    REQUIRE(mesh.faces.size() == 12);
    CHECK(mesh.faces[0] == Face{3, 2, 1});
    CHECK(mesh.faces[1] == Face{3, 1, 0});
    CHECK(mesh.faces[10] == Face{4, 5, 6});
    REQUIRE(mesh.parts.size() == 3);
    CHECK(mesh.parts[1].name == "sides");
    CHECK(mesh.parts[1].first_face == 2);
    CHECK(mesh.parts[1].face_count == 8);
    CHECK(mesh.parts[2].face_count == 2);
}

TEST_CASE("unit and up axis of an OBJ file are converted")
{
    const std::string text = "v 1 2 3\nv 1 0 0\nv 0 1 0\r\nf 1 2 3\r\n";
    CHECK((read_text(text, LengthUnit::cm, Axis::y).vertices[0] - Vec3(0.01, -0.03, 0.02)).norm() < 1e-15);
    CHECK((read_text(text, LengthUnit::mm, Axis::x).vertices[0] - Vec3(0.002, 0.003, 0.001)).norm() < 1e-15);
    CHECK((read_text(text, LengthUnit::inch, Axis::z).vertices[0] - 0.0254 * Vec3(1, 2, 3)).norm() < 1e-15);
    CHECK(read_text(text).parts.empty());
}

TEST_CASE("texture coordinates are given per vertex and not scaled")
{
    std::vector<Vec2> texture;
    read_text("v 0 0 0\nv 100 0 0\nv 0 100 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 2/2/9 3/3/9 1/1/9\n", LengthUnit::cm, Axis::z,
              &texture);
    REQUIRE(texture.size() == 3);
    CHECK(texture[1] == Vec2(1, 0));
    read_text(cube, LengthUnit::m, Axis::z, &texture);
    CHECK(texture.empty());
}

TEST_CASE("a written OBJ file reads back with the same objects")
{
    const ScratchFolder folder;
    const std::vector<Vec3> square{{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.123456789, 0}, {0, 0.1, 0}};
    const std::vector<Face> faces{{0, 1, 2}, {0, 2, 3}};
    const std::vector<Vec2> flat{{0, 0}, {0.1, 0}, {0.1, 0.1}, {0, 0.1}};
    const std::string path = folder.path("out.obj");
    const std::vector<ObjObject> objects{{"front", square, faces, flat}, {"back", square, faces, flat}};
    write_obj(path, objects);
    std::vector<Vec2> texture;
    const TriangleMesh mesh = read_obj(path, LengthUnit::m, Axis::z, &texture);
    REQUIRE(mesh.parts.size() == 2);
    CHECK(mesh.parts[1].name == "back");
    CHECK(mesh.faces[3] == Face{4, 6, 7});
    CHECK((mesh.vertices[6] - square[2]).norm() < 1e-9);
    CHECK(texture[5] == flat[1]);
}

TEST_CASE("objects that are sewn to each other share vertices and keep their own texture coordinates")
{
    const ScratchFolder folder;
    const std::vector<Vec3> left{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, right{{1, 0, 0}, {2, 0, 0}, {1, 1, 0}};
    const std::vector<Face> face{{0, 1, 2}};
    const std::vector<Vec2> flat{{0, 0}, {1, 0}, {1, 1}}, flat_right{{5, 0}, {6, 0}, {5, 1}};
    const std::vector<int> none{-1, -1, -1}, repeated{1, -1, 2};
    const std::vector<ObjObject> objects{{"left", left, face, flat, none},
                                         {"right\nv 0 0 0\\", right, face, flat_right, repeated}};
    write_obj(folder.path("sewn.obj"), objects);
    const std::string text = read_file_text(folder.path("sewn.obj"), "an OBJ file");
    CHECK(text.find("o right_v 0 0 0_\n") != std::string::npos);
    CHECK(text.find("f 1/1 2/2 3/3\n") != std::string::npos);
    CHECK(text.find("f 2/4 4/5 3/6\n") != std::string::npos);
    const TriangleMesh mesh = read_obj(folder.path("sewn.obj"), LengthUnit::m, Axis::z);
    CHECK(mesh.vertices.size() == 4);
    CHECK(mesh.faces == std::vector<Face>{{0, 1, 2}, {1, 3, 2}});
}

TEST_CASE("a closed body passes and its volume is positive")
{
    const TriangleMesh mesh = read_text(cube);
    const BodyMeshReport report = check_body_mesh(mesh);
    CHECK(report.volume == Approx(1));
    CHECK(report.extent == Approx(1));
    CHECK(report.boundary_edges == 0);
    CHECK(report.nonmanifold_edges == 0);
    CHECK(report.inconsistent_edges == 0);
    CHECK_FALSE(report.size_looks_wrong);
    CHECK_NOTHROW(require_closed_body(mesh, "cube.obj"));
}

TEST_CASE("holes, flipped faces, doubled edges and flat faces of a body are counted")
{
    TriangleMesh mesh = read_text(cube);
    TriangleMesh open = mesh;
    open.faces.pop_back();
    CHECK(check_body_mesh(open).boundary_edges == 3);

    TriangleMesh flipped = mesh;
    std::swap(flipped.faces[4][0], flipped.faces[4][1]);
    CHECK(check_body_mesh(flipped).inconsistent_edges == 3);

    TriangleMesh doubled = mesh;
    doubled.faces.push_back(doubled.faces[0]);
    CHECK(check_body_mesh(doubled).nonmanifold_edges == 3);

    TriangleMesh flat = mesh;
    flat.faces.push_back({0, 1, 1});
    CHECK(check_body_mesh(flat).first_zero_area_face == 12);

    for (Face& face : mesh.faces) std::swap(face[0], face[1]);
    CHECK(check_body_mesh(mesh).volume == Approx(-1));
}

TEST_CASE("a body of 47 500 triangles reads and is checked in a fraction of a second")
{
    const TriangleMesh mesh = round_body(154, 155);
    REQUIRE(mesh.faces.size() > 47000);
    const ScratchFolder folder;
    const std::vector<ObjObject> objects{{"body", mesh.vertices, mesh.faces}};
    write_obj(folder.path("body.obj"), objects);
    const auto begin = std::chrono::steady_clock::now();
    const TriangleMesh again = read_obj(folder.path("body.obj"), LengthUnit::m, Axis::z);
    const auto end = std::chrono::steady_clock::now();
    CHECK(again.faces == mesh.faces);
    CHECK_NOTHROW(require_closed_body(again, "body.obj"));
    // The limit is ten times the usual duration, because the machine may be busy or the build unoptimised.
    CHECK(std::chrono::duration<double>(end - begin).count() < 0.5);
}
