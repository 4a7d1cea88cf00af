#include <Eigen/LU>

#include "io/pattern/pattern_json.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;

namespace {

// Two squares of 40 cm. %EDGE% stands for the text after the endpoints of the front's first edge, %ROTATION% for the
// front's angles.
constexpr const char* squares = R"({
"pattern": {
  "panels": {
    "front": {"translation": [10, 100, 25], "rotation": %ROTATION%, "label": "body",
      "vertices": [[0, 0], [40, 0], [40, 40], [0, 40]],
      "edges": [{"endpoints": [0, 1]%EDGE%}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]},
    "back": {"translation": [0, 100, -25], "rotation": [0, 0, 0],
      "vertices": [[0, 0], [40, 0], [40, 40], [0, 40]],
      "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]}
  },
  %ORDER%
  "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 1}],
               [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 3}, "right_wrong"]]
},
"parameters": {}, "parameter_order": [],
"properties": {"units_in_meter": %UNITS%, "curvature_coords": "%COORDS%", "normalized_edge_loops": true}
})";

struct Variant {
    std::string edge, rotation = "[0, 0, 0]", order, units = "100", coords = "relative";
};

Pattern read_variant(const Variant& variant, const PatternConventions& conventions = {})
{
    std::string text = squares;
    const auto fill = [&](const std::string& mark, const std::string& value) {
        text.replace(text.find(mark), mark.size(), value);
    };
    fill("%EDGE%", variant.edge.empty() ? "" : ", \"curvature\": " + variant.edge);
    fill("%ROTATION%", variant.rotation);
    fill("%ORDER%", variant.order);
    fill("%UNITS%", variant.units);
    fill("%COORDS%", variant.coords);
    const ScratchFolder folder;
    return read_pattern_json(folder.write("squares.json", text), conventions);
}

PatternEdge first_edge(const std::string& curvature, const std::string& coords = "relative")
{
    Variant variant;
    variant.edge = curvature;
    variant.coords = coords;
    return read_variant(variant).panels.at(0).edges.at(0);
}

bool close(const Vec2& a, double x, double y) { return (a - Vec2(x, y)).norm() < 1e-12; }

}  // namespace

TEST_CASE("a pattern's lengths become metres and its up direction z")
{
    const Pattern pattern = read_variant({});
    CHECK(pattern.name == "squares");
    REQUIRE(pattern.panels.size() == 2);
    const PatternPanel& front = pattern.panels[0];
    CHECK(front.name == "front");
    CHECK(close(front.vertices[2], 0.4, 0.4));
    CHECK((front.translation - Vec3(0.1, -0.25, 1.0)).norm() < 1e-12);
    CHECK((front.rotation * Vec3(0, 1, 0) - Vec3(0, 0, 1)).norm() < 1e-12);
    CHECK((front.rotation * Vec3(1, 0, 0) - Vec3(1, 0, 0)).norm() < 1e-12);
    CHECK(front.rotation.determinant() == Approx(1));
    CHECK(pattern.findings.empty());
}

TEST_CASE("units_in_meter scales every length")
{
    Variant variant;
    variant.units = "1000";
    const Pattern pattern = read_variant(variant);
    CHECK(close(pattern.panels[0].vertices[1], 0.04, 0));
    CHECK(pattern.panels[0].translation.z() == Approx(0.1));
}

TEST_CASE("the up axis of the scene overrides that of the format")
{
    PatternConventions conventions;
    conventions.up = PatternAxis::z;
    CHECK((read_variant({}, conventions).panels[0].translation - Vec3(0.1, 1.0, 0.25)).norm() < 1e-12);
    conventions.up = PatternAxis::x;
    CHECK((read_variant({}, conventions).panels[0].translation - Vec3(1.0, 0.25, 0.1)).norm() < 1e-12);
}

TEST_CASE("control points count along and across the edge when they are relative")
{
    const PatternEdge quadratic = first_edge(R"({"type": "quadratic", "params": [[0.5, -0.25]]})");
    CHECK(quadratic.curve == EdgeCurve::quadratic);
    CHECK(close(quadratic.control[0], 0.2, -0.1));
    const PatternEdge cubic = first_edge(R"({"type": "cubic", "params": [[0.25, 0.5], [0.75, -0.5]]})");
    CHECK(cubic.curve == EdgeCurve::cubic);
    CHECK(close(cubic.control[0], 0.1, 0.2));
    CHECK(close(cubic.control[1], 0.3, -0.2));
    CHECK(first_edge("[0.5, 0.25]").curve == EdgeCurve::quadratic);
    CHECK(close(first_edge("[0.5, 0.25]").control[0], 0.2, 0.1));
}

TEST_CASE("absolute control points are panel coordinates in the file's unit")
{
    CHECK(close(first_edge(R"({"type": "quadratic", "params": [[15, -5]]})", "absolute").control[0], 0.15, -0.05));
}

TEST_CASE("a circle keeps its flags and its radius is in the file's unit")
{
    const PatternEdge arc = first_edge(R"({"type": "circle", "params": [25, 0, 1]})");
    CHECK(arc.curve == EdgeCurve::arc);
    CHECK(arc.radius == Approx(0.25));
    CHECK_FALSE(arc.large_arc);
    CHECK(arc.right);
    CHECK(first_edge(R"({"type": "circle", "params": [25, true, false]})").large_arc);
    CHECK(first_edge(R"({"type": "circle", "params": [19.99999, 0, 0]})").radius == Approx(0.2));
}

TEST_CASE("stitches name panels by index and the third element keeps the direction")
{
    const Pattern pattern = read_variant({});
    REQUIRE(pattern.stitches.size() == 2);
    CHECK(pattern.stitches[0].a.panel == 0);
    CHECK(pattern.stitches[0].b.panel == 1);
    CHECK(pattern.stitches[1].b.edge == 3);
    CHECK_FALSE(pattern.stitches[0].same_direction);
    CHECK(pattern.stitches[1].same_direction);
}

TEST_CASE("panel_order decides the order of the panels, otherwise the file does")
{
    Variant variant;
    variant.order = R"("panel_order": ["back", "front"],)";
    const Pattern pattern = read_variant(variant);
    CHECK(pattern.panels[0].name == "back");
    CHECK(pattern.stitches[0].a.panel == 1);
    CHECK(read_variant({}).panels[0].name == "front");
}

TEST_CASE("rotations are applied as Rz Ry Rx, with a warning where the order matters")
{
    Variant variant;
    variant.rotation = "[90, 90, 0]";
    PatternConventions conventions;
    conventions.up = PatternAxis::z;
    const Pattern pattern = read_variant(variant, conventions);
    // Rx maps y to z, then Ry maps z to x.
    CHECK((pattern.panels[0].rotation * Vec3(0, 1, 0) - Vec3(1, 0, 0)).norm() < 1e-12);
    REQUIRE(pattern.findings.size() == 1);
    CHECK(describe(pattern.findings[0]).find("pattern.panels.front.rotation") != std::string::npos);
    conventions.rotation_order = RotationOrder::zyx;
    CHECK((read_variant(variant, conventions).panels[0].rotation * Vec3(0, 1, 0) - Vec3(0, 0, 1)).norm() < 1e-12);
    variant.rotation = "[0, 45, 360]";
    CHECK(read_variant(variant).findings.empty());
}

TEST_CASE("a pattern may leave out what is zero or empty, and hold comments, a last comma and any line ends")
{
    constexpr const char* text = R"(/* a square */ {
"pattern": {"panels": { // the only "panel": [
  "front": {"vertices": [[0, 0], [40, 0], [40, 40], [0, 40],],
    "edges": [{"endpoints": [0, 1], "curvature": null}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
              {"endpoints": [3, 0]}]}},
  "panel_order": ["front"]},
"properties": {"units_in_meter": 100, "//": "/* no comment */"}, // end
})";
    const ScratchFolder folder;
    for (const std::string line_end : {"\n", "\r\n", "\r"}) {
        std::string lines = "\xef\xbb\xbf";  // a byte order mark
        for (const char c : std::string(text)) lines += c == '\n' ? line_end : std::string(1, c);
        const Pattern pattern = read_pattern_json(folder.write("square.json", lines), {});
        REQUIRE(pattern.panels.size() == 1);
        CHECK(pattern.panels[0].translation == Vec3::Zero());
        CHECK((pattern.panels[0].rotation * Vec3(0, 1, 0) - Vec3(0, 0, 1)).norm() < 1e-12);
        CHECK(pattern.panels[0].edges[0].curve == EdgeCurve::straight);
        CHECK(pattern.stitches.empty());
        CHECK(pattern.findings.empty());
        CHECK(pattern.place("pattern.panels.front.edges[3]").line == 5);
        CHECK(pattern.place("pattern.panels.front.edges[3]").column == 15);
        CHECK(pattern.place("pattern.panels.front.edges[7]").line == 4);
        CHECK(pattern.place("pattern.panel").line == 2);
    }
}
