// Outlines, panel meshes, seams and prolongations between resolutions of garments.

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "host/garment/assemble.hpp"
#include "host/garment/outline.hpp"
#include "host/garment/pins.hpp"
#include "host/garment/sheet.hpp"
#include "host/mesh/panel_mesh.hpp"
#include "host/model/prolongation.hpp"
#include "io/errors.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

PatternPanel polygon_panel(const std::string& name, const std::vector<Vec2>& corners,
                           const Vec3& translation = Vec3::Zero())
{
    PatternPanel panel;
    panel.name = name;
    panel.vertices = corners;
    panel.translation = translation;
    const int count = int(corners.size());
    for (int i = 0; i < count; ++i) {
        PatternEdge edge;
        edge.start = i;
        edge.end = (i + 1) % count;
        panel.edges.push_back(edge);
    }
    return panel;
}

PatternPanel rectangle(const std::string& name, double width, double height, const Vec3& translation = Vec3::Zero())
{
    return polygon_panel(name, {{0, 0}, {width, 0}, {width, height}, {0, height}}, translation);
}

void make_arc(PatternEdge& edge, double radius, bool large, bool right)
{
    edge.curve = EdgeCurve::arc;
    edge.radius = radius;
    edge.large_arc = large;
    edge.right = right;
}

// A sleeve-like panel: a cubic cap, a quadratic hem, straight sides of which one is short.
PatternPanel curved_panel(const std::string& name)
{
    PatternPanel panel = polygon_panel(name, {{0, 0}, {0.4, 0}, {0.45, 0.3}, {0.0, 0.307}, {0.0, 0.3}});
    panel.edges[0].curve = EdgeCurve::quadratic;
    panel.edges[0].control[0] = Vec2(0.2, -0.06);
    panel.edges[2].curve = EdgeCurve::cubic;
    panel.edges[2].control = {Vec2(0.35, 0.33), Vec2(0.3, 0.5)};
    return panel;
}

Pattern pattern_of(const std::vector<PatternPanel>& panels)
{
    Pattern pattern;
    pattern.name = "test";
    pattern.file = "test.json";
    pattern.panels = panels;
    return pattern;
}

Cloth assemble(const Pattern& pattern, double edge_length)
{
    return assemble_garment(pattern, edge_length, "cotton", {});
}

double smallest_angle(const Vec2& a, const Vec2& b, const Vec2& c)
{
    const auto angle = [](const Vec2& u, const Vec2& v) { return std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v)); };
    return std::min({angle(b - a, c - a), angle(c - b, a - b), angle(a - c, b - c)}) * 180 / std::numbers::pi;
}

struct Quality {
    double smallest = 180, mean = 0, edge_length = 0;
};

Quality quality(const std::vector<Vec2>& points, const std::vector<Face>& faces)
{
    Quality result;
    for (const Face& face : faces) {
        const double angle = smallest_angle(points[face[0]], points[face[1]], points[face[2]]);
        result.smallest = std::min(result.smallest, angle);
        result.mean += angle / double(faces.size());
        for (int i = 0; i < 3; ++i)
            result.edge_length += (points[face[i]] - points[face[(i + 1) % 3]]).norm() / (3.0 * faces.size());
    }
    return result;
}

std::set<std::array<int, 2>> edges_of(const std::vector<Face>& faces, bool boundary_only)
{
    std::map<std::array<int, 2>, int> uses;
    for (const Face& face : faces)
        for (int i = 0; i < 3; ++i)
            ++uses[{std::min(face[i], face[(i + 1) % 3]), std::max(face[i], face[(i + 1) % 3])}];
    std::set<std::array<int, 2>> edges;
    for (const auto& [edge, count] : uses)
        if (!boundary_only || count == 1) edges.insert(edge);
    return edges;
}

double face_area(const Cloth& cloth, const Face& face)
{
    const std::vector<Vec2>& points = cloth.panel_coordinates;
    return signed_area({points[face[0]], points[face[1]], points[face[2]]});
}

std::string message_of(const Pattern& pattern, double edge_length = 0.05)
{
    try {
        assemble(pattern, edge_length);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

std::vector<double> interpolate(const Prolongation& prolongation, const std::vector<double>& values)
{
    std::vector<double> result;
    for (std::size_t row = 0; row + 1 < prolongation.offset.size(); ++row) {
        double sum = 0;
        for (int k = prolongation.offset[row]; k < prolongation.offset[row + 1]; ++k)
            sum += prolongation.weight[k] * values[prolongation.column[k]];
        result.push_back(sum);
    }
    return result;
}

}  // namespace

TEST_CASE("an arc edge has the length of its circle and lies on the side that its flags say")
{
    PatternPanel panel = polygon_panel("disc", {{-1, 0}, {1, 0}});
    const double radius = std::sqrt(2.0);  // a quarter and three quarters of a circle through the two ends
    for (const bool large : {false, true})
        for (const bool right : {false, true}) {
            make_arc(panel.edges[0], radius, large, right);
            const EdgePath path(panel, panel.edges[0]);
            CHECK(path.length() == Approx(radius * std::numbers::pi * (large ? 1.5 : 0.5)));
            const double bulge = large ? radius + 1 : radius - 1;
            CHECK(path.at(0.5).y() == Approx(right ? -bulge : bulge));
            CHECK(path.at(0.5).x() == Approx(0).margin(1e-12));
        }
}

TEST_CASE("Bezier edges are sampled at equal arc length")
{
    const PatternPanel panel = curved_panel("sleeve");
    for (const int edge : {0, 2}) {
        const EdgePath path(panel, panel.edges[edge]);
        constexpr int parts = 7, fine = 2000;
        double total = 0;
        for (int part = 0; part < parts; ++part) {
            double length = 0;
            for (int i = 0; i < fine; ++i)
                length += (path.at((part + double(i + 1) / fine) / parts) - path.at((part + double(i) / fine) / parts))
                              .norm();
            CHECK(length == Approx(path.length() / parts).epsilon(1e-5));
            total += length;
        }
        CHECK(total == Approx(path.length()).epsilon(1e-6));
    }
}

TEST_CASE("an arc whose radius is too small becomes a half circle and a warning")
{
    PatternPanel panel = rectangle("front", 0.2, 0.2);
    make_arc(panel.edges[0], 0.05, false, true);
    const Cloth cloth = assemble(pattern_of({panel}), 0.02);
    REQUIRE(cloth.findings.size() == 1);
    CHECK(describe(cloth.findings[0]).find("pattern.panels.front.edges[0]") != std::string::npos);
    CHECK(cloth.outline[0].length == Approx(0.1 * std::numbers::pi));
}

TEST_CASE("a disc of two arcs is meshed to half a percent of its area")
{
    PatternPanel panel = polygon_panel("disc", {{-0.2, 0}, {0.2, 0}});
    make_arc(panel.edges[0], 0.2, false, true);
    make_arc(panel.edges[1], 0.2, false, true);
    const Cloth cloth = assemble(pattern_of({panel}), 0.02);
    CHECK(cloth.panels[0].rest_area == Approx(std::numbers::pi * 0.04).epsilon(0.005));
    CHECK(cloth.panels[0].rest_boundary == Approx(0.4 * std::numbers::pi).epsilon(0.005));
    CHECK(quality(cloth.panel_coordinates, cloth.faces).smallest > 25);
}

TEST_CASE("every panel is a disc of positive faces whose boundary is the outline's samples")
{
    PatternPanel clockwise = curved_panel("clockwise");
    std::reverse(clockwise.edges.begin(), clockwise.edges.end());
    for (PatternEdge& edge : clockwise.edges) {
        std::swap(edge.start, edge.end);
        if (edge.curve == EdgeCurve::cubic) std::swap(edge.control[0], edge.control[1]);
    }
    const PatternPanel concave = polygon_panel("concave", {{0, 0},
                                                           {0.4, 0},
                                                           {0.4, 0.19},
                                                           {0.6, 0.19},
                                                           {0.6, 0},
                                                           {1, 0},
                                                           {1, 0.4},
                                                           {0.51, 0.4},
                                                           {0.5, 0.25},
                                                           {0.49, 0.4},
                                                           {0, 0.4}});
    for (const double edge_length : {0.04, 0.011}) {
        const Cloth cloth = assemble(pattern_of({curved_panel("sleeve"), clockwise, concave}), edge_length);
        for (std::size_t index = 0; index < cloth.panels.size(); ++index) {
            const ClothPanel& panel = cloth.panels[index];
            const std::vector<Face> faces(cloth.faces.begin() + panel.first_face,
                                          cloth.faces.begin() + panel.first_face + panel.face_count);
            double area = 0;
            for (const Face& face : faces) {
                REQUIRE(face_area(cloth, face) > 0);
                area += face_area(cloth, face);
                for (const int vertex : face)
                    REQUIRE((vertex >= panel.first_vertex && vertex < panel.first_vertex + panel.vertex_count));
            }
            CHECK(area == Approx(panel.rest_area).epsilon(1e-9));
            CHECK(panel.vertex_count - int(edges_of(faces, false).size()) + panel.face_count == 1);
            std::set<std::array<int, 2>> sampled;
            for (const OutlineSamples& samples : cloth.outline)
                for (std::size_t i = 1; samples.panel == int(index) && i < samples.vertices.size(); ++i)
                    sampled.insert({std::min(samples.vertices[i - 1], samples.vertices[i]),
                                    std::max(samples.vertices[i - 1], samples.vertices[i])});
            CHECK(edges_of(faces, true) == sampled);
        }
        for (const OutlineSamples& samples : cloth.outline) {
            const PatternPanel& panel = samples.panel == 0   ? curved_panel("")
                                        : samples.panel == 1 ? clockwise
                                                             : concave;
            const EdgePath path(panel, panel.edges[samples.edge]);
            for (std::size_t i = 0; i < samples.vertices.size(); ++i)
                CHECK((cloth.panel_coordinates[samples.vertices[i]] - path.at(samples.parameters[i])).norm() < 1e-12);
        }
    }
}

TEST_CASE("panel meshes have angles above twenty degrees and edges of about the target length")
{
    for (const double edge_length : {0.04, 0.02, 0.01}) {
        const Cloth cloth = assemble(pattern_of({curved_panel("sleeve")}), edge_length);
        const Quality result = quality(cloth.panel_coordinates, cloth.faces);
        CAPTURE(edge_length);
        CHECK(result.smallest > 20);
        CHECK(result.mean > 45);
    }
    const Cloth square = assemble(pattern_of({rectangle("square", 1, 1)}), 0.02);
    const Quality result = quality(square.panel_coordinates, square.faces);
    CHECK(result.smallest > 28);
    CHECK(result.mean > 48);
    CHECK(result.edge_length == Approx(0.02).epsilon(0.04));
}

TEST_CASE("mesh edges prefer no direction")
{
    const Cloth cloth = assemble(pattern_of({rectangle("square", 1, 1)}), 0.012);
    Vec2 fourth = Vec2::Zero(), sixth = Vec2::Zero();  // moments of the edge directions
    int count = 0;
    for (const auto& [a, b] : edges_of(cloth.faces, false)) {
        const Vec2 middle = 0.5 * (cloth.panel_coordinates[a] + cloth.panel_coordinates[b]);
        if ((middle - Vec2(0.5, 0.5)).cwiseAbs().maxCoeff() > 0.4) continue;
        const Vec2 along = cloth.panel_coordinates[b] - cloth.panel_coordinates[a];
        const double angle = std::atan2(along.y(), along.x());
        fourth += Vec2(std::cos(4 * angle), std::sin(4 * angle));
        sixth += Vec2(std::cos(6 * angle), std::sin(6 * angle));
        ++count;
    }
    CHECK(fourth.norm() / count < 0.03);
    CHECK(sixth.norm() / count < 0.15);
}

TEST_CASE("meshing the same panel twice gives the same mesh")
{
    const Pattern pattern = pattern_of({curved_panel("sleeve"), rectangle("square", 0.3, 0.3)});
    const Cloth first = assemble(pattern, 0.01), second = assemble(pattern, 0.01);
    CHECK(first.faces == second.faces);
    CHECK(first.panel_coordinates == second.panel_coordinates);
}

TEST_CASE("both sides of a seam are sampled alike, in opposite directions unless the stitch says otherwise")
{
    Pattern pattern = pattern_of({rectangle("left", 0.3, 0.5), rectangle("right", 0.3, 0.8, {0.35, 0, 0})});
    pattern.stitches.push_back({{0, 1}, {1, 3}, false});
    const Cloth cloth = assemble(pattern, 0.02);
    REQUIRE(cloth.seams.size() == 1);
    const Seam& seam = cloth.seams[0];
    const OutlineSamples &a = cloth.outline[seam.side_a], &b = cloth.outline[seam.side_b];
    CHECK(a.vertices.size() == 41);  // 0.8 m / 0.02 m, although side a has only 0.5 m
    CHECK(b.vertices.size() == 41);
    CHECK(a.parameters == b.parameters);
    CHECK(seam.length_a == Approx(0.5));
    CHECK(seam.length_b == Approx(0.8));
    REQUIRE(seam.pair_count == 41);
    for (int i = 0; i < 41; ++i) {
        const auto [first, second] = cloth.seam_pairs[seam.first_pair + i];
        CHECK(cloth.panel_coordinates[first].y() / 0.5 ==
              Approx(cloth.panel_coordinates[second].y() / 0.8).margin(1e-9));
    }
    CHECK(cloth.findings.empty());

    pattern.stitches[0].same_direction = true;
    CHECK(assemble(pattern, 0.02).seam_pairs.front()[1] == b.vertices.front());
}

TEST_CASE("a dart does not pair its tip with itself and no pair is listed twice")
{
    Pattern pattern =
        pattern_of({polygon_panel("front", {{0, 0}, {0.2, 0}, {0.22, 0.15}, {0.24, 0}, {0.4, 0}, {0.4, 0.4}, {0, 0.4}}),
                    rectangle("back", 0.4, 0.4, {0, 0, -0.1})});
    pattern.stitches.push_back({{0, 1}, {0, 2}, false});  // the dart
    pattern.stitches.push_back({{0, 4}, {1, 1}, true});
    pattern.stitches.push_back({{0, 5}, {1, 2}, true});
    const Cloth cloth = assemble(pattern, 0.01);
    std::set<std::array<int, 2>> known;
    for (const auto& [a, b] : cloth.seam_pairs) {
        CHECK(a != b);
        CHECK(known.insert({std::min(a, b), std::max(a, b)}).second);
    }
    CHECK(cloth.seams[0].pair_count == int(cloth.outline[cloth.seams[0].side_a].vertices.size()) - 1);
    CHECK(cloth.seams[2].pair_count == int(cloth.outline[cloth.seams[2].side_a].vertices.size()) - 1);
    CHECK(cloth.findings.empty());
}

TEST_CASE("faulty patterns are refused with the place of the fault")
{
    const PatternPanel good = rectangle("front", 0.4, 0.4);
    PatternPanel open = good;
    open.edges[2].end = 0;
    CHECK(message_of(pattern_of({open})).find("test.json: pattern.panels.front.edges[3]: found an open outline") == 0);

    CHECK(message_of(pattern_of({polygon_panel("bow", {{0, 0}, {0.4, 0.4}, {0.4, 0}, {0, 0.4}})}))
              .find("test.json: pattern.panels.bow.edges[0]: found an edge that crosses or touches edges[2]") == 0);

    PatternPanel bulging = good;  // the arc leaves the panel through its left edge
    make_arc(bulging.edges[0], 0.24, true, false);
    CHECK(message_of(pattern_of({bulging})).find("crosses or touches") != std::string::npos);

    CHECK(message_of(pattern_of({polygon_panel("line", {{0, 0}, {0.4, 0}, {0.2, 0}})}))
              .find("test.json: pattern.panels.line: found an outline without area") == 0);

    PatternPanel pointed = good;
    pointed.vertices[1] = pointed.vertices[0];
    CHECK(message_of(pattern_of({pointed})).find("pattern.panels.front.edges[0]: found an edge whose ends coincide") !=
          std::string::npos);

    Pattern twice = pattern_of({good, rectangle("back", 0.4, 0.4)});
    twice.stitches.push_back({{0, 1}, {1, 1}, false});
    twice.stitches.push_back({{1, 1}, {0, 3}, false});
    const std::string message = message_of(twice);
    CHECK(message.find("pattern.stitches[1]") != std::string::npos);
    CHECK(message.find("back.edges[1], which is also in stitches[0]") != std::string::npos);

    CHECK(message_of(pattern_of({good}), 1e-5).find("garment.resolution") == 0);
    CHECK_THROWS_WITH(assemble_garment(pattern_of({good}), 0.05, "cotton", {{"frnt", "denim"}}),
                      contains_text("garment.fabrics.frnt") && contains_text("did you mean `front`"));
    CHECK(message_of(pattern_of({good})).empty());
}

TEST_CASE("panels start where their rotation, translation and cylinder put them")
{
    PatternPanel panel = rectangle("sleeve", 0.4, 0.2, {1, 2, 3});
    panel.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    const Vec3 flat = place_on_panel(panel, Vec2(0.3, 0.1));
    CHECK((flat - Vec3(0.9, 2.3, 3)).norm() < 1e-12);

    panel.rotation = Mat3::Identity();
    panel.wrap = PanelWrap{0.1, 0.2, false};
    const Cloth cloth = assemble(pattern_of({panel}), 0.02);
    for (std::size_t i = 0; i < cloth.positions.size(); ++i) {
        const Vec3 arm = cloth.positions[i] - panel.translation - Vec3(0.2, cloth.panel_coordinates[i].y(), -0.1);
        CHECK(arm.norm() == Approx(0.1));
        CHECK(0.1 * std::atan2(arm.x(), arm.z()) == Approx(cloth.panel_coordinates[i].x() - 0.2).margin(1e-9));
    }
    const double behind = place_on_panel({.name = "",
                                          .vertices = {},
                                          .edges = {},
                                          .translation = Vec3::Zero(),
                                          .rotation = Mat3::Identity(),
                                          .wrap = PanelWrap{0.1, 0.2, true},
                                          .fabric = ""},
                                         Vec2(0.3, 0))
                              .z();
    CHECK(behind > 0);
}

TEST_CASE("faces of a flat panel face its rotated z axis, also where the outline runs clockwise")
{
    const PatternPanel panel = polygon_panel("back", {{0, 0}, {0, 0.2}, {0.2, 0.2}, {0.2, 0}});
    const Cloth cloth = assemble(pattern_of({panel}), 0.03);
    for (const Face& face : cloth.faces) {
        const Vec3 u = cloth.positions[face[1]] - cloth.positions[face[0]],
                   v = cloth.positions[face[2]] - cloth.positions[face[0]];
        CHECK(u.x() * v.y() - u.y() * v.x() > 0);
    }
}

TEST_CASE("appended cloths keep their panels, seams and pins")
{
    Pattern pattern = pattern_of({rectangle("left", 0.2, 0.2), rectangle("right", 0.2, 0.2, {0.25, 0, 0})});
    pattern.stitches.push_back({{0, 1}, {1, 3}, false});
    const Cloth garment = assemble(pattern, 0.05);
    SheetScene sheet;
    sheet.resolution = 3;
    const auto held_sheet = [&](const char* key) {
        Cloth cloth = make_sheet(sheet, "scene.toml", key);
        hold_vertices(cloth, {6, 8});
        return cloth;
    };
    Cloth both = held_sheet("sheet[0]");
    append_cloth(both, garment);
    append_cloth(both, held_sheet("sheet[1]"));
    const int shift = 9, last = shift + int(garment.positions.size());
    CHECK(both.pinned == std::vector<int>{6, 8, last + 6, last + 8});
    CHECK(both.panels.size() == 4);
    CHECK(both.seam_pairs[0][0] == garment.seam_pairs[0][0] + shift);
    CHECK(both.outline[both.seams[0].side_b].panel == 2);
    for (const ClothPanel& panel : both.panels)
        for (int face = panel.first_face; face < panel.first_face + panel.face_count; ++face)
            for (const int vertex : both.faces[face])
                CHECK((vertex >= panel.first_vertex && vertex < panel.first_vertex + panel.vertex_count));
}

TEST_CASE("a prolongation reproduces linear functions inside polygonal panels and its rows sum to one")
{
    const Pattern polygons =
        pattern_of({rectangle("square", 0.5, 0.3),
                    polygon_panel("dart", {{0, 0}, {0.2, 0}, {0.22, 0.15}, {0.24, 0}, {0.4, 0}, {0.3, 0.4}})});
    const Cloth coarse = assemble(polygons, 0.05), fine = assemble(polygons, 0.017);
    const Prolongation prolongation = make_prolongation(coarse, fine);
    REQUIRE(prolongation.offset.size() == fine.positions.size() + 1);
    std::vector<double> values;
    for (const Vec2& point : coarse.panel_coordinates) values.push_back(3 * point.x() - 2 * point.y() + 1);
    const std::vector<double> result = interpolate(prolongation, values);
    for (std::size_t i = 0; i < result.size(); ++i)
        CHECK(result[i] ==
              Approx(3 * fine.panel_coordinates[i].x() - 2 * fine.panel_coordinates[i].y() + 1).margin(1e-8));

    const Pattern curved = pattern_of({curved_panel("sleeve")});
    const Cloth coarse_sleeve = assemble(curved, 0.06), fine_sleeve = assemble(curved, 0.008);
    const Prolongation sleeve = make_prolongation(coarse_sleeve, fine_sleeve);
    for (const double sum : interpolate(sleeve, std::vector<double>(coarse_sleeve.positions.size(), 1.0)))
        CHECK(sum == Approx(1));
    CHECK(*std::min_element(sleeve.weight.begin(), sleeve.weight.end()) >= 0);
    std::vector<double> across;
    for (const Vec2& point : coarse_sleeve.panel_coordinates) across.push_back(point.x());
    const std::vector<double> moved = interpolate(sleeve, across);
    for (std::size_t i = 0; i < moved.size(); ++i)
        CHECK(std::abs(moved[i] - fine_sleeve.panel_coordinates[i].x()) < 0.01);
    CHECK_THROWS_AS(make_prolongation(coarse, fine_sleeve), std::invalid_argument);
}

TEST_CASE("both sides of a seam get the same prolongation weights from paired coarse vertices")
{
    Pattern pattern = pattern_of({rectangle("left", 0.3, 0.5), curved_panel("right")});
    pattern.stitches.push_back({{0, 1}, {1, 2}, false});
    const Cloth coarse = assemble(pattern, 0.05), fine = assemble(pattern, 0.012);
    const Prolongation prolongation = make_prolongation(coarse, fine);
    std::map<int, int> partner;
    for (const auto& [a, b] : coarse.seam_pairs) partner[a] = b;
    for (const auto& [a, b] : fine.seam_pairs) {
        std::map<int, double> from_a, from_b;
        for (int k = prolongation.offset[a]; k < prolongation.offset[a + 1]; ++k)
            from_a[partner.at(prolongation.column[k])] = prolongation.weight[k];
        for (int k = prolongation.offset[b]; k < prolongation.offset[b + 1]; ++k)
            from_b[prolongation.column[k]] = prolongation.weight[k];
        for (const auto& [column, weight] : from_a) CHECK(from_b[column] == Approx(weight).margin(1e-9));
    }
}

TEST_CASE("prolongations have no weights that only rounding has left")
{
    const Pattern pattern = pattern_of({curved_panel("panel")});
    const Prolongation prolongation = make_prolongation(assemble(pattern, 0.05), assemble(pattern, 0.012));
    for (std::size_t row = 0; row + 1 < prolongation.offset.size(); ++row) {
        double sum = 0;
        for (int k = prolongation.offset[row]; k < prolongation.offset[row + 1]; ++k) {
            CHECK(prolongation.weight[k] > 1e-7);
            sum += prolongation.weight[k];
        }
        CHECK(sum == Approx(1).epsilon(1e-14));
    }
}
