#include <algorithm>
#include <cmath>
#include <ctime>

#include "host/examine/body_mesh.hpp"
#include "host/examine/body_pairs.hpp"
#include "host/examine/file_mesh.hpp"
#include "io/errors.hpp"
#include "io/file_text.hpp"
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

ObjMesh read_text(const std::string& text, LengthUnit unit = LengthUnit::m, Axis up = Axis::z)
{
    const ScratchFolder folder;
    return read_obj(folder.write("mesh.obj", text), unit, up);
}

FileMesh cut(const std::string& text)
{
    std::vector<Finding> findings;
    return cut_polygons(read_text(text), findings);
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
    const TriangleMesh mesh = cut(cube).mesh;
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

TEST_CASE("texture coordinates are given per corner and not scaled")
{
    const ObjMesh mesh = read_text(
        "v 0 0 0\nv 100 0 0\nv 0 100 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 2/2/9 3/3/9 1/1/9\nf 1 2 3/1\n", LengthUnit::cm);
    REQUIRE(mesh.texture.size() == 3);
    CHECK(mesh.texture[1] == Vec2(1, 0));
    CHECK(mesh.corner_textures == std::vector<int>{1, 2, 0, -1, -1, 0});
    CHECK(read_text(cube).corner_textures.empty());
}

TEST_CASE("byte order marks, blanks of Unicode, all line ends and continued lines are read")
{
    const std::vector<std::string> texts{
        "\xEF\xBB\xBFv 1 2 3\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "v\xC2\xA0"
        "1 2\xE2\x80\x89"
        "3\nv 1 0 0\xC2\xA0\nv\xA0"
        "0 1 0\nf 1 2 3\n",
        "v 1 2 3\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
        "v 1 2 3\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3",
        "v 1 \\\n2 3\nv 1 0 0\nv 0 1 0\nf 1 \\\r\n2 \\\n3\n",
    };
    for (const std::string& text : texts) {
        INFO(text);
        const ObjMesh mesh = read_text(text);
        REQUIRE(mesh.vertices.size() == 3);
        CHECK(mesh.vertices[0] == Vec3(1, 2, 3));
        CHECK(mesh.corner_vertices == std::vector<int>{0, 1, 2});
    }
    CHECK(read_text(texts[4]).polygon_lines == std::vector<int>{5});
    CHECK(read_text("g a\\\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").vertex_lines.front() == 2);
}

TEST_CASE("a concave face becomes the same surface whichever corner it begins with")
{
    // An L of 0.12 m^2 that is not flat, so that other triangles would be another surface.
    const std::string points =
        "v -0.2 -0.2 0.3\nv 0.2 -0.2 0.3\nv 0.2 0 0.31\nv 0 0 0.3\nv 0 0.2 0.3\nv -0.2 0.2 0.32\n";
    std::vector<Face> first;
    for (int start = 0; start < 6; ++start) {
        std::string face = "f";
        for (int k = 0; k < 6; ++k) face += " " + std::to_string((start + k) % 6 + 1);
        const TriangleMesh mesh = cut(points + face + "\n").mesh;
        double area = 0;
        std::vector<Face> faces = mesh.faces;
        for (Face& f : faces) {
            area += area_of(mesh.vertices, f);
            std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
        }
        std::sort(faces.begin(), faces.end());
        if (start == 0) first = faces;
        CHECK(faces == first);
        CHECK(area == Approx(0.12).epsilon(0.02));
    }
}

TEST_CASE("faces that are no polygons are refused in the numbers of the file")
{
    const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\n";
    CHECK_THROWS_WITH(cut(points + "f 1 2 3 4\nf 1 2 2 3\n"), contains_text(":7:") && contains_text("vertex 2 twice"));
    CHECK_THROWS_WITH(cut(points + "f 1 2 4 3\n"), contains_text(":6:") && contains_text("cross"));
    CHECK_THROWS_WITH(cut(points + "f 1 2 3\nf 1 2 5\n"), contains_text(":7:") && contains_text("without area"));
    // A corner in the middle of a side is no fault.
    CHECK(cut(points + "f 1 2 5 3 4\n").mesh.faces.size() == 3);
}

TEST_CASE("vertices that no face uses are left out and told")
{
    std::vector<Finding> findings;
    const FileMesh mesh = cut_polygons(read_text("v 1e8 0 0\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 2 3 4\n"), findings);
    CHECK(mesh.mesh.vertices.size() == 3);
    CHECK(mesh.mesh.faces == std::vector<Face>{{0, 1, 2}});
    CHECK(mesh.number(0) == 2);
    REQUIRE(findings.size() == 1);
    CHECK(findings[0].severity == Severity::note);
    CHECK_THAT(describe(findings[0]), contains_text(":1: vertex 1"));
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
    const ObjMesh mesh = read_obj(path, LengthUnit::m, Axis::z);
    REQUIRE(mesh.parts.size() == 2);
    CHECK(mesh.parts[1].name == "back");
    CHECK(std::ranges::equal(mesh.polygon(3), Face{4, 6, 7}));
    CHECK((mesh.vertices[6] - square[2]).norm() < 1e-9);
    CHECK(mesh.texture[5] == flat[1]);
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
    const ObjMesh mesh = read_obj(folder.path("sewn.obj"), LengthUnit::m, Axis::z);
    CHECK(mesh.vertices.size() == 4);
    CHECK(mesh.corner_vertices == std::vector<int>{0, 1, 2, 1, 3, 2});
}

namespace {

// Processor time that it takes to read and to examine a round body [s].
double examination_time(int rings, int columns)
{
    const TriangleMesh mesh = round_body(rings, columns);
    const ScratchFolder folder;
    const std::vector<ObjObject> objects{{"body", mesh.vertices, mesh.faces}};
    write_obj(folder.path("body.obj"), objects);
    const std::clock_t begin = std::clock();
    std::vector<Finding> findings;
    FileMesh again = cut_polygons(read_obj(folder.path("body.obj"), LengthUnit::m, Axis::z), findings);
    examine_body(again, "body[0]", findings);
    const std::clock_t end = std::clock();
    CHECK(again.mesh.faces == mesh.faces);
    CHECK(findings.empty());
    return double(end - begin) / CLOCKS_PER_SEC;
}

// Processor time that it takes to find a round body within a larger one [s].
double search_time(int rings, int columns)
{
    std::vector<Body> bodies(2);
    bodies[0].mesh = bodies[1].mesh = round_body(rings, columns);
    for (Vec3& x : bodies[0].mesh.vertices) x *= 0.5;
    const std::clock_t begin = std::clock();
    const std::vector<Finding> findings = examine_body_pairs(bodies, std::vector<InputPlace>(2));
    const std::clock_t end = std::clock();
    REQUIRE(findings.size() == 1);
    CHECK_THAT(findings[0].text, contains_text("lies within"));
    return double(end - begin) / CLOCKS_PER_SEC;
}

// Checks that four times the triangles take little more than four times as long; sixteen times would tell of every
// triangle with every other. The first run finds the machine's memory and threads unprepared, and does not count.
void check_growth(double (*time)(int rings, int columns))
{
    time(77, 78);
    const double small = time(77, 78), large = time(154, 155);
    CHECK(large < 9 * small);
}

}  // namespace

TEST_CASE("reading and examining a body takes little more than in proportion to its triangles")
{
    check_growth(examination_time);
}

TEST_CASE("finding a body within another takes little more than in proportion to their triangles")
{
    check_growth(search_time);
}
