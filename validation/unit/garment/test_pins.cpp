#include "host/garment/pins.hpp"

#include "host/garment/sheet.hpp"
#include "host/scene/scene_model.hpp"
#include "host/solver/contact/pin_paths.hpp"
#include "io/scene/read_scene.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

Cloth small_sheet(MeshFamily family = MeshFamily::automatic, const std::string& name = "")
{
    SheetScene sheet;
    sheet.name = name;
    sheet.resolution = 4;  // rows 0-3, 4-7, 8-11, 12-15 from the bottom
    sheet.mesh_family = family;
    return make_sheet(sheet, "scene.toml", "sheet[0]");
}

std::vector<int> chosen(const Cloth& cloth, const PinChoice& choice)
{
    const auto place = [](const std::string& key) { return InputPlace{"scene.toml", 0, 0, "pins." + key}; };
    return chosen_vertices(cloth, choice, {place("panel"), place("vertices"), place("edges")});
}

Cloth cloth_of(const std::string& text)
{
    return build_scene_model(read_scene_text(text + "[solver]\npreconditioner = \"block_jacobi\"\n", "scene.toml"))
        .cloth_model.cloth;
}

constexpr const char* two_sheets = R"([[sheet]]
resolution = 3
[[sheet]]
name = "upper"
resolution = 2
)";
constexpr const char* shirt = "[garment]\npattern = \"builtin:vest\"\nresolution = 0.1\n";

}  // namespace

TEST_CASE("pins hold the vertices that their word names")
{
    const Cloth cloth = small_sheet();
    using Vertices = std::vector<int>;
    CHECK(chosen(cloth, {"", PinGroup::none, ""}).empty());
    CHECK(chosen(cloth, {"", PinGroup::corners, ""}) == Vertices{0, 3, 12, 15});
    CHECK(chosen(cloth, {"", PinGroup::top_corners, ""}) == Vertices{12, 15});
    CHECK(chosen(cloth, {"", PinGroup::top_edge, ""}) == Vertices{12, 13, 14, 15});
    CHECK(chosen(cloth, {"", PinGroup::left_edge, ""}) == Vertices{0, 4, 8, 12});
    CHECK(chosen(cloth, {"", PinGroup::two_rows, ""}) == Vertices{0, 1, 4, 5, 8, 9, 12, 13});
    CHECK(chosen(cloth, {"", PinGroup::top_corners, "7, 2,15"}) == Vertices{2, 7, 12, 15});
    CHECK_THROWS_WITH(chosen(cloth, {"", PinGroup::none, "16"}),
                      contains_text("pins.vertices") && contains_text("from 0 to 15 of sheet[0]"));
    CHECK_THROWS_WITH(chosen(cloth, {"", PinGroup::none, "1,x"}), contains_text("pins.vertices"));
    CHECK_THROWS_WITH(chosen(cloth, {"", PinGroup::none, "1 2"}),
                      contains_text("`1 2`") && contains_text("separated by commas"));
    CHECK(chosen(small_sheet(MeshFamily::irregular), {"", PinGroup::left_edge, ""}) == Vertices{0, 4, 8, 12});
}

TEST_CASE("pins act on the sheet that they name, whose vertices count from 0")
{
    const std::string text = two_sheets;
    using Vertices = std::vector<int>;
    CHECK(cloth_of(text + "[pins]\nsheet = \"top_corners\"\n").pinned == Vertices{6, 8, 11, 12});
    CHECK(cloth_of(text + "[[pins.hold]]\npanel = \"sheet[0]\"\nvertices = \"0, 4\"\n").pinned == Vertices{0, 4});
    CHECK(cloth_of(text + "[[pins.hold]]\npanel = \"upper\"\nvertices = \"0\"\ngroup = \"right_edge\"\n").pinned ==
          Vertices{9, 10, 12});
    const Cloth moved = cloth_of(text +
                                 "[[pins.motion]]\npanel = \"upper\"\nvertices = \"1\"\n"
                                 "[[pins.motion]]\ngroup = \"center\"\n");
    REQUIRE(moved.pin_motions.size() == 2);
    CHECK(moved.pin_motions[0].vertices == Vertices{10});
    CHECK(moved.pin_motions[1].vertices.size() == 2);
}

TEST_CASE("pins hold vertices of a garment's panel")
{
    const Cloth cloth = cloth_of(std::string(shirt) + "[[pins.hold]]\npanel = \"back\"\ngroup = \"top_edge\"\n");
    CHECK_FALSE(cloth.pinned.empty());
    for (const ClothPanel& panel : cloth.panels)
        for (const int v : cloth.pinned)
            if (v >= panel.first_vertex && v < panel.first_vertex + panel.vertex_count) CHECK(panel.name == "back");
}

TEST_CASE("pins and elastic take edges of a garment's panel by their index in the pattern")
{
    const std::string elastic = "[[garment.elastic]]\npanel = \"back\"\nedges = \"1, 0\"\nlength = 0.7\n";
    const Cloth cloth = cloth_of(std::string(shirt) + elastic + "[[pins.hold]]\npanel = \"front\"\nedges = \"2\"\n");
    const auto edge_of = [&](const std::string& panel, int edge) {
        for (const OutlineSamples& samples : cloth.outline)
            if (cloth.panels[samples.panel].name == panel && samples.edge == edge) return samples.vertices;
        return std::vector<int>{};
    };
    std::vector<int> held = edge_of("front", 2);
    std::sort(held.begin(), held.end());
    CHECK(cloth.pinned == held);
    REQUIRE(cloth.elastics.size() == 2);
    CHECK(cloth.elastics[0].vertices == edge_of("back", 1));
    CHECK(cloth.elastics[1].vertices == edge_of("back", 0));
    CHECK(cloth.elastics[0].shrink == 0.7);
}

TEST_CASE("a point at a seam moves once, though several of its vertices are listed")
{
    Cloth cloth = small_sheet();
    cloth.seam_pairs.push_back({0, 1});
    PinMotionScene motion;
    motion.velocity = Vec3(0, 0, 1);
    move_vertices(cloth, {0, 1}, motion);
    const auto places = PinPaths(cloth, make_topology(cloth, true)).places(motion.end);
    REQUIRE(places.size() == 1);
    CHECK((places[0].second - cloth.positions[0] - Vec3(0, 0, 1)).norm() < 1e-12);
}

TEST_CASE("pins that could not act are refused with what they could be")
{
    const std::string sheets = two_sheets, garment = shirt;
    const auto refused = [](const std::string& text, const std::string& key, const std::string& expected) {
        INFO(text);
        CHECK_THROWS_WITH(cloth_of(text), contains_text(key) && contains_text(expected));
    };
    refused(garment + "[pins]\nsheet = \"top_edge\"\n", "pins.sheet", "[[pins.hold]]");
    refused(garment + "[pins]\nvertices = \"99999\"\n", "pins.vertices", "[[pins.hold]]");
    refused(garment + "[[pins.motion]]\n", "pins.motion[0].group", "panel");
    refused(garment + "[[pins.hold]]\npanel = \"frnt\"\ngroup = \"corners\"\n", "pins.hold[0].panel", "\"front\"");
    refused(garment + "[[pins.hold]]\npanel = \"front\"\nvertices = \"99999\"\n", "pins.hold[0].vertices", "of front");
    refused(garment + "[[pins.hold]]\npanel = \"front\"\nedges = \"99\"\n", "pins.hold[0].edges", "of front");
    refused(garment + "[[garment.elastic]]\npanel = \"frnt\"\nedges = \"0\"\n", "elastic[0].panel", "\"front\"");
    refused(garment + "[[garment.elastic]]\npanel = \"front\"\n", "garment.elastic[0]", "edges");
    refused(garment + "[[garment.elastic]]\npanel = \"front\"\nedges = \"99\"\n", "elastic[0].edges", "of front");
    refused(sheets + "[[pins.hold]]\npanel = \"upper\"\nedges = \"0\"\n", "pins.hold[0].edges", "a sheet");
    refused(sheets + "[pins]\nvertices = \"0\"\n", "pins.vertices", "\"sheet[0]\"");
    refused(sheets + "[[pins.motion]]\nvertices = \"0\"\n", "pins.motion[0].vertices", "panel");
    refused(sheets + "[[pins.hold]]\ngroup = \"corners\"\n", "pins.hold[0]", "panel");
    refused(sheets + "[[pins.hold]]\npanel = \"upper\"\n", "pins.hold[0]", "what of `upper` is held");
    refused(sheets + "[[pins.hold]]\npanel = \"upper\"\nvertices = \"4\"\n", "pins.hold[0].vertices", "from 0 to 3");
}

TEST_CASE("a sheet has as many vertices a side as are asked for, from 2 on")
{
    CHECK(cloth_of("[[sheet]]\nresolution = 2\n").positions.size() == 4);
    CHECK(cloth_of("[[sheet]]\nresolution = 3\n").positions.size() == 9);
}
