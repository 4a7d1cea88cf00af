#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/examine/pattern.hpp"
#include "host/garment/assemble.hpp"
#include "io/pattern/pattern_json.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;

namespace {

// What is found in a pattern whose panels (30 cm wide and 40 cm high unless said otherwise) face each other.
struct Tube {
    std::string front = "[[-15, -20], [15, -20], [15, 20], [-15, 20]]";
    std::string back = front;
    std::string back_place = R"("translation": [0, 100, -12], "rotation": [0, 180, 0])";
    std::string stitches = sewn({{1, 3}, {3, 1}});
    std::string more_panels;
    double units_in_meter = 100;

    static std::string sewn(const std::vector<std::array<int, 2>>& edges, const std::string& third = "")
    {
        std::vector<std::string> texts;
        for (const auto& [front, back] : edges)
            texts.push_back(fmt::format(R"([{{"panel": "front", "edge": {}}}, {{"panel": "back", "edge": {}}}{}])",
                                        front, back, third));
        return fmt::format("[\n{}\n]", fmt::join(texts, ",\n"));
    }

    std::vector<Finding> findings(double edge_length = 0.05) const
    {
        const std::string edges = R"("edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
            {"endpoints": [3, 0]}])";
        const std::string text = fmt::format(R"({{"pattern": {{"panels": {{
"front": {{"translation": [0, 100, 12], "vertices": {0}, {3}}},
"back": {{{2}, "vertices": {1}, {3}}}{5}}},
"stitches": {4}}}, "properties": {{"units_in_meter": {6}}}}})",
                                             front, back, back_place, edges, stitches, more_panels, units_in_meter);
        const ScratchFolder folder;
        const Pattern pattern = read_pattern_json(folder.write("tube.json", text), {});
        return examine_pattern(pattern, assemble_garment(pattern, edge_length, "cotton", {}), edge_length);
    }

    // The only finding, as a line.
    std::string finding(const std::string& kind, Severity severity) const
    {
        const std::vector<Finding> all = findings();
        std::string text;
        for (const Finding& one : all) text += one.kind + " " + describe(one) + "\n";
        INFO(text);
        REQUIRE(all.size() == 1);
        CHECK(all[0].kind == kind);
        CHECK(all[0].severity == severity);
        return text;
    }
};

const std::string mirrored = "[[15, -20], [-15, -20], [-15, 20], [15, 20]]";
const std::string reversed = "[[-15, 20], [15, 20], [15, -20], [-15, -20]]";

}  // namespace

TEST_CASE("nothing is found in panels that are sewn as they face each other, whichever way round they are drawn")
{
    CHECK(Tube{}.findings().empty());
    Tube turned_over;  // its outside is at -z, so it needs no half turn
    turned_over.back = mirrored;
    turned_over.back_place = R"("translation": [0, 100, -12])";
    turned_over.stitches = Tube::sewn({{1, 3}, {3, 1}});
    CHECK(turned_over.findings().empty());
    Tube wrong_side;
    wrong_side.back = reversed;
    wrong_side.stitches = Tube::sewn({{1, 3}, {3, 1}}, ", \"right_wrong\"");
    CHECK(wrong_side.findings().empty());
}

TEST_CASE("a band in one piece around a tube is taken neither for crossed nor for mirrored")
{
    Tube tube;
    tube.more_panels = R"(,
"band": {"translation": [0, 122, 14], "vertices": [[-30, 0], [0, 0], [30, 0], [30, 4], [-30, 4]],
  "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 4]},
            {"endpoints": [4, 0]}]})";
    tube.stitches.pop_back();
    tube.stitches += R"(, [{"panel": "band", "edge": 0}, {"panel": "front", "edge": 2}],
[{"panel": "band", "edge": 1}, {"panel": "back", "edge": 2}],
[{"panel": "band", "edge": 2}, {"panel": "band", "edge": 4}]])";
    for (const Finding& finding : tube.findings()) CHECK(describe(finding) == "");
}

TEST_CASE("a panel drawn clockwise that is sewn mirrored to one that is not is told with both names")
{
    for (const auto& edges : {std::vector<std::array<int, 2>>{{1, 3}, {3, 1}}, {{1, 1}, {3, 3}}}) {
        Tube tube;
        tube.back = edges[0][1] == 3 ? mirrored : reversed;
        tube.stitches = Tube::sewn(edges);
        const std::string text = tube.finding("side", Severity::warning);
        for (const char* part :
             {"tube.json:2:", "`front` (drawn counter-clockwise)", "`back` (drawn clockwise)", "turn"})
            CHECK_THAT(text, contains_text(part));
    }
}

TEST_CASE("seams that cross as placed are told, with the edges and the ways to turn them")
{
    Tube tube;
    tube.back = reversed;
    const std::vector<Finding> found = tube.findings();
    REQUIRE(found.size() == 2);
    CHECK(found[1].kind == "seam");
    for (const char* part : {"tube.json:8:", "stitches[1]", "front.edges[3]", "back.edges[1]", "add", "right_wrong",
                             "`back` (drawn clockwise) the same way round"})
        CHECK_THAT(describe(found[1]), contains_text(part));
    tube.stitches = Tube::sewn({{1, 0}, {3, 2}}, ", \"right_wrong\"");
    CHECK_FALSE(tube.findings().empty());
}

TEST_CASE("a panel that is sewn to nothing is noted")
{
    Tube tube;
    tube.more_panels = R"(,
"lid": {"translation": [17, 118, -12], "rotation": [0, 0, 0], "vertices": [[-2, 0], [2, 0], [2, 2], [-2, 2]],
  "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]})";
    CHECK(tube.finding("loose_panel", Severity::note).find("`lid`") != std::string::npos);
}

TEST_CASE("seams whose sides differ in length are noted, warned of or refused, with both lengths")
{
    Tube tube;
    tube.back = "[[-15, -10], [15, -10], [15, 10], [-15, 10]]";
    CHECK_THAT(tube.finding("seam_length", Severity::note),
               contains_text("0.4 m long and back.edges[3] 0.2 m (2 to 1)"));
    tube.back = "[[-15, -5], [15, -5], [15, 5], [-15, 5]]";
    const std::vector<Finding> found = tube.findings();
    REQUIRE(found.size() == 2);
    CHECK(found[0].severity == Severity::warning);
    for (const char* part : {"tube.json:7:", "pattern.stitches[0]", "front.edges[1] is 0.4 m", "0.1 m (4 to 1)"})
        CHECK_THAT(describe(found[0]), contains_text(part));
    tube.back = "[[-15, -0.4], [15, -0.4], [15, 0.4], [-15, 0.4]]";
    CHECK_THROWS_WITH(tube.findings(), contains_text("0.4 m long") && contains_text("0.008 m long: 50 to 1"));
}

TEST_CASE("panels far from those they are sewn to, unused corners, short edges and doll's sizes are told")
{
    Tube far;
    far.back_place = R"("translation": [0, 100, -1200], "rotation": [0, 180, 0])";
    CHECK_THAT(far.finding("placement", Severity::warning), contains_text("`front`") && contains_text("12.1 m"));

    Tube unused;
    unused.back = "[[-15, -20], [15, -20], [15, 20], [-15, 20], [0, 0], [0, 0]]";
    CHECK_THAT(unused.finding("unused_vertex", Severity::note),
               contains_text("back.vertices[4]") && contains_text("2 of"));

    Tube narrow;
    narrow.back = narrow.front = "[[-15, -20], [15, -20], [15, 20], [14.5, 20]]";
    narrow.stitches = Tube::sewn({{1, 1}}, ", true");
    const std::vector<Finding> found = narrow.findings();
    const auto is_short = [](const Finding& finding) { return finding.kind == "short_edge"; };
    REQUIRE(std::ranges::count_if(found, is_short) == 1);
    CHECK_THAT(describe(*std::ranges::find_if(found, is_short)),
               contains_text("front.edges[2]") && contains_text("5 mm"));

    Tube small;
    small.units_in_meter = 1000;
    CHECK_THAT(small.finding("unit", Severity::warning),
               contains_text("measures 0.04 m") && contains_text("100 (cm) would mean 0.4 m"));
}
