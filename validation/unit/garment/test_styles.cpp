#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "host/garment/assemble.hpp"
#include "host/garment/outline.hpp"
#include "host/mannequin/mannequin.hpp"
#include "host/styles/styles.hpp"
#include "io/errors.hpp"
#include "io/pattern/pattern_json.hpp"
#include "io/pattern/write_pattern.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;

namespace {

/// Parity of the faces above the point.
bool is_inside(const TriangleMesh& mesh, const Vec3& point)
{
    int crossings = 0;
    for (const Face& f : mesh.faces) {
        const Vec3 &a = mesh.vertices[f[0]], &b = mesh.vertices[f[1]], &c = mesh.vertices[f[2]];
        if (std::max({a.z(), b.z(), c.z()}) < point.z() || std::abs(a.x() - point.x()) > 0.05 ||
            std::abs(a.y() - point.y()) > 0.05)
            continue;
        auto turn = [&](const Vec3& from, const Vec3& to) {
            return (from.x() - point.x()) * (to.y() - point.y()) - (from.y() - point.y()) * (to.x() - point.x());
        };
        const double u = turn(b, c), v = turn(c, a), w = turn(a, b);
        if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) continue;
        if ((u * a.z() + v * b.z() + w * c.z()) / (u + v + w) > point.z()) ++crossings;
    }
    return crossings % 2 == 1;
}

double distance_to_vertices(const TriangleMesh& mesh, const Vec3& point)
{
    double nearest = 1e9;
    for (const Vec3& vertex : mesh.vertices) nearest = std::min(nearest, (vertex - point).squaredNorm());
    return std::sqrt(nearest);
}

struct Dressed {
    TriangleMesh mesh;
    StyleBody body;
};

Dressed mannequin_of(BodySize size)
{
    Dressed made{make_mannequin(mannequin_size(size)), {}};
    made.body = style_body(made.mesh, {});
    return made;
}

// The mannequin of each size, made once.
const Dressed& mannequin(BodySize size)
{
    static std::map<BodySize, Dressed> made;
    const auto found = made.find(size);
    return found != made.end() ? found->second : made.emplace(size, mannequin_of(size)).first->second;
}

double edge_length(const Pattern& pattern, const StitchSide& side)
{
    const PatternPanel& panel = pattern.panels[side.panel];
    return EdgePath(panel, panel.edges[side.edge]).length();
}

// How much longer the longer side of a seam is, by style and panel: gathers, and sleeves that are gathered to cuffs.
double fullness(const Pattern& pattern, const PatternStitch& stitch)
{
    const std::string &a = pattern.panels[stitch.a.panel].name, &b = pattern.panels[stitch.b.panel].name;
    if (pattern.name == "gathered_skirt" && a.starts_with("waistband") != b.starts_with("waistband")) return 1.8;
    if (a.ends_with("_cuff") != b.ends_with("_cuff")) return pattern.name == "shirt" ? 1.12 : 1.15;
    return 1;
}

const std::vector<BodySize> sizes{BodySize::XS, BodySize::M, BodySize::XXL, BodySize::child110};

}  // namespace

TEST_CASE("styles have simple counter-clockwise outlines, and seams of equal length but for gathers")
{
    const std::string name = GENERATE(from_range(style_names()));
    for (const BodySize size : sizes) {
        CAPTURE(name, word_of(size));
        const Pattern pattern = draft_style(name, mannequin(size).body);
        std::vector<Finding> findings;
        std::set<std::string> names;
        for (const PatternPanel& panel : pattern.panels) {
            CHECK_NOTHROW(check_outline(pattern, panel, findings));
            CHECK(signed_area(sample_outline(panel, std::vector<int>(panel.edges.size(), 16))) > 0);
            CHECK((panel.rotation.transpose() * panel.rotation - Mat3::Identity()).norm() < 1e-9);
            CHECK(panel.rotation.determinant() == Approx(1));
            CHECK(names.insert(panel.name).second);
        }
        CHECK(findings.empty());
        std::set<std::pair<int, int>> sewn;
        for (const PatternStitch& stitch : pattern.stitches) {
            const double a = edge_length(pattern, stitch.a), b = edge_length(pattern, stitch.b);
            CAPTURE(pattern.panels[stitch.a.panel].name, stitch.a.edge, pattern.panels[stitch.b.panel].name);
            CHECK(std::max(a, b) / std::min(a, b) == Approx(fullness(pattern, stitch)).epsilon(0.008));
            CHECK(sewn.insert({stitch.a.panel, stitch.a.edge}).second);
            CHECK(sewn.insert({stitch.b.panel, stitch.b.edge}).second);
        }
    }
}

TEST_CASE("styles start outside the mannequin")
{
    const std::string name = GENERATE(from_range(style_names()));
    const Dressed& dressed = mannequin(BodySize::M);
    const Pattern pattern = draft_style(name, dressed.body);
    const Cloth cloth = assemble_garment(pattern, 0.05, "cotton", {}, 1e6);
    for (const ClothPanel& panel : cloth.panels) {
        CAPTURE(name, panel.name);
        double gap = 1e9;
        bool inside = false;
        for (int v = panel.first_vertex; v < panel.first_vertex + panel.vertex_count; ++v) {
            inside = inside || is_inside(dressed.mesh, cloth.positions[v]);
            gap = std::min(gap, distance_to_vertices(dressed.mesh, cloth.positions[v]));
        }
        CHECK_FALSE(inside);
        CHECK(gap > 0.003);
    }
}

TEST_CASE("a style that is written as JSON is read back with the same panels, seams and places")
{
    const std::string name = GENERATE(from_range(style_names()));
    CAPTURE(name);
    const Pattern pattern = draft_style(name, mannequin(BodySize::M).body);
    const ScratchFolder folder;
    const Pattern read = read_pattern_json(folder.write("style.json", pattern_json(pattern)), {});
    REQUIRE(read.panels.size() == pattern.panels.size());
    for (std::size_t p = 0; p < read.panels.size(); ++p) {
        const PatternPanel &a = pattern.panels[p], &b = read.panels[p];
        CHECK(a.name == b.name);
        REQUIRE(a.edges.size() == b.edges.size());
        CHECK((a.rotation - b.rotation).norm() < 1e-9);
        CHECK((a.translation - b.translation).norm() < 1e-9);
        for (std::size_t v = 0; v < a.vertices.size(); ++v) CHECK((a.vertices[v] - b.vertices[v]).norm() < 1e-9);
        for (std::size_t e = 0; e < a.edges.size(); ++e) {
            CHECK(a.edges[e].curve == b.edges[e].curve);
            for (int k : {0, 1})
                CHECK((EdgePath(a, a.edges[e]).at(0.3 + 0.4 * k) - EdgePath(b, b.edges[e]).at(0.3 + 0.4 * k)).norm() <
                      1e-8);
        }
        const Vec2 point(0.1, -0.1);
        CHECK((place_on_panel(a, point) - place_on_panel(b, point)).norm() < 1e-9);
    }
    REQUIRE(read.stitches.size() == pattern.stitches.size());
    for (std::size_t s = 0; s < read.stitches.size(); ++s) {
        const PatternStitch &a = pattern.stitches[s], &b = read.stitches[s];
        CHECK((a.a.panel == b.a.panel && a.a.edge == b.a.edge && a.b.panel == b.b.panel && a.b.edge == b.b.edge &&
               a.same_direction == b.same_direction));
    }
}

TEST_CASE("a style is drafted for a body wherever it stands and whichever way it faces")
{
    const TriangleMesh& mesh = mannequin(BodySize::M).mesh;
    TriangleMesh turned = mesh;
    const double angle = 2;
    for (Vec3& x : turned.vertices)
        x = {std::cos(angle) * x.x() - std::sin(angle) * x.y() + 3, std::sin(angle) * x.x() + std::cos(angle) * x.y(),
             x.z()};
    const Pattern here = draft_style("tshirt", mannequin(BodySize::M).body);
    const Pattern there = draft_style("tshirt", style_body(turned, {}));
    for (std::size_t p = 0; p < here.panels.size(); ++p) {
        const Vec3 a = place_on_panel(here.panels[p], {0, 0}), b = place_on_panel(there.panels[p], {0, 0});
        const Vec3 moved(std::cos(angle) * a.x() - std::sin(angle) * a.y() + 3,
                         std::sin(angle) * a.x() + std::cos(angle) * a.y(), a.z());
        CHECK((moved - b).norm() < 0.01);
    }
}

TEST_CASE("an unknown style is refused with the nearest name")
{
    CHECK_THROWS_WITH(draft_style("tshrt", mannequin(BodySize::M).body), contains_text("did you mean `tshirt`"));
}
