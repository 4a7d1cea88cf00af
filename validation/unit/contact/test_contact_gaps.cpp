#include "host/collision/ccd.hpp"
#include "host/solver/contact/contact_gaps.hpp"
#include "host/solver/contact/contact_tuning.hpp"
#include "validation/measure/crumpled_sheets.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

constexpr double least = 0.002;

FabricTable fabrics()
{
    FabricTable table = test_fabrics();
    table["thick"] = table.at("test");
    table["thick"].thickness = 0.005;
    return table;
}

// A grid whose columns stand at given places; two columns near each other make slivers.
Cloth columns(const std::vector<double>& places, int rows, double spacing)
{
    Cloth cloth = grid_cloth(int(places.size()), rows, spacing);
    for (std::size_t v = 0; v < cloth.positions.size(); ++v) {
        const double x = places[v % places.size()];
        cloth.panel_coordinates[v].x() = cloth.positions[v].x() = x;
    }
    return cloth;
}

// Pairs of a cloth that lies at rest, without a common corner, and their distances there.
template <class Visit>
void for_each_pair(const Cloth& cloth, const Visit& visit)
{
    const auto offer = [&](const PairCandidate& pair) {
        PairCorners x;
        for (int i = 0; i < 4; ++i) {
            const Vec2& u = cloth.panel_coordinates[pair.corner[i]];
            x[i] = {u.x(), u.y(), 0};
        }
        visit(pair, pair_distance(x, pair.edges));
    };
    const auto have_common = [](const auto& a, const auto& b) {
        return std::any_of(a.begin(), a.end(), [&](int v) { return std::find(b.begin(), b.end(), v) != b.end(); });
    };
    for (int v = 0; v < int(cloth.positions.size()); ++v)
        for (const Face& f : cloth.faces)
            if (!have_common(std::array{v}, f)) offer({{v, f[0], f[1], f[2]}, false});
    for (const Face& f : cloth.faces)
        for (const Face& g : cloth.faces)
            for (int k = 0; k < 3; ++k)
                for (int l = 0; l < 3; ++l) {
                    const std::array a{f[k], f[(k + 1) % 3]}, b{g[l], g[(l + 1) % 3]};
                    if (!have_common(a, b)) offer({{a[0], a[1], b[0], b[1]}, true});
                }
}

PairCandidate over(int vertex, const Face& face) { return {{vertex, face[0], face[1], face[2]}, false}; }

ContactGaps gaps_of(const Cloth& cloth) { return {make_topology(cloth, true), cloth, fabrics(), least}; }

}  // namespace

TEST_CASE("cloth does not press on its own neighbours where a triangle is narrower than the fabric is thick")
{
    // Columns of 3 cm, 30 um and 10 um: some vertices without a common triangle are nearer than contact sets in.
    const Cloth cloth = columns({0, 0.03, 0.03003, 0.06, 0.06001, 0.09}, 6, 0.02);
    const ContactGaps gaps = gaps_of(cloth);
    int narrow = 0, wide = 0;
    for_each_pair(cloth, [&](const PairCandidate& pair, double distance) {
        CHECK(gaps.of(pair) <= ContactTuning::gap_of_rest * distance);
        CHECK(gaps.of(pair) > 0);
        (gaps.of(pair) < 0.1 * least ? narrow : wide) += 1;
    });
    CHECK(narrow > 0);
    CHECK(wide > 100 * narrow / 10);
}

TEST_CASE("a sliver changes contact neither far from it nor with another piece of cloth")
{
    Cloth cloth = columns({0, 0.03, 0.03001, 0.06, 0.09, 0.12}, 6, 0.02);
    const Face own_sliver = cloth.faces[2], own_far = cloth.faces[8];
    const int first = int(cloth.positions.size());
    add_panel(cloth, grid_cloth(4, 4, 0.02), {0, 0, 0.003});
    const ContactGaps gaps = gaps_of(cloth);
    CHECK(gaps.largest() == least);
    CHECK(gaps.of(over(first + 5, own_sliver)) == least);
    CHECK(gaps.of(over(first - 1, own_sliver)) == least);  // the far corner of the same sheet, folded onto it
    CHECK(gaps.of(over(first - 1, own_far)) == least);
}

TEST_CASE("each side of a pair asks for half of its fabric's thickness")
{
    Cloth cloth = grid_cloth(4, 4, 0.02);
    for (int panel : {1, 2}) add_panel(cloth, grid_cloth(4, 4, 0.02), {0, 0, 0.01 * panel});
    cloth.panels[1].fabric = cloth.panels[2].fabric = "thick";
    const ContactGaps gaps = gaps_of(cloth);
    const auto face = [&](int panel) { return cloth.faces[cloth.panels[panel].first_face]; };
    const auto vertex = [&](int panel) { return cloth.panels[panel].first_vertex + 15; };
    CHECK(gaps.of(over(vertex(0), face(0))) == least);
    CHECK(gaps.of(over(vertex(0), face(1))) == Approx(0.5 * (least + 0.005)));
    CHECK(gaps.of(over(vertex(1), face(0))) == Approx(0.5 * (least + 0.005)));
    CHECK(gaps.of(over(vertex(1), face(2))) == Approx(0.005));
    CHECK(gaps.largest() == 0.005);
    // With a body each fabric has its own.
    const PairCandidate thin{{0, 1, -1, -2}, true}, thick{{16, 17, -1, -2}, true};
    CHECK(gaps.of(thin) == ContactTuning::body_gap * least);
    CHECK(gaps.of(thick) == ContactTuning::body_gap * 0.005);
}

TEST_CASE("a piece of fine mesh has its own gap")
{
    Cloth cloth = grid_cloth(6, 6, 0.001);
    add_panel(cloth, grid_cloth(4, 4, 0.02), {0, 0, 0.01});
    const ContactGaps gaps = gaps_of(cloth);
    const Face fine = cloth.faces[0], coarse = cloth.faces[std::size_t(cloth.panels[1].first_face)];
    CHECK(gaps.of(over(35, fine)) < 0.5 * least);
    CHECK(gaps.of(over(36 + 15, coarse)) == least);
}
