#include "host/examine/pattern.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/examine/seams.hpp"

namespace selvage {
namespace {

constexpr double doll_size = 0.1;   // [m]; the largest panel of a garment for people is longer
constexpr double short_edge = 0.2;  // of the mesh's edges
constexpr std::size_t most_named = 5;

std::string panel_key(const Pattern& pattern, int panel) { return "pattern.panels." + pattern.panels[panel].name; }

// Returns names in back quotes with commas, the first few of them.
std::string name_list(const std::vector<std::string>& names)
{
    const std::vector<std::string> first(names.begin(), names.begin() + long(std::min(names.size(), most_named)));
    const std::string more =
        names.size() > most_named ? fmt::format(" and {} more", names.size() - most_named) : std::string();
    return fmt::format("`{}`{}", fmt::join(first, "`, `"), more);
}

void find_loose_panels(const Pattern& pattern, std::vector<Finding>& findings)
{
    if (pattern.panels.size() < 2) return;
    std::set<int> sewn;
    for (const PatternStitch& stitch : pattern.stitches) {
        sewn.insert(stitch.a.panel);
        sewn.insert(stitch.b.panel);
    }
    std::vector<int> loose;
    std::vector<std::string> names;
    for (int p = 0; p < int(pattern.panels.size()); ++p) {
        if (sewn.contains(p)) continue;
        loose.push_back(p);
        names.push_back(pattern.panels[p].name);
    }
    if (loose.empty()) return;
    findings.push_back({"loose_panel",
                        pattern.place(panel_key(pattern, loose[0])),
                        fmt::format("sewn to nothing: {}", name_list(names)),
                        {},
                        Severity::note});
}

void find_unused_corners(const Pattern& pattern, std::vector<Finding>& findings)
{
    for (int p = 0; p < int(pattern.panels.size()); ++p) {
        const PatternPanel& panel = pattern.panels[p];
        std::vector<char> used(panel.vertices.size());
        for (const PatternEdge& edge : panel.edges) used[edge.start] = used[edge.end] = 1;
        const auto first = std::ranges::find(used, char(0));
        if (first == used.end()) continue;
        findings.push_back({"unused_vertex",
                            pattern.place(fmt::format("{}.vertices[{}]", panel_key(pattern, p), first - used.begin())),
                            fmt::format("{} of the panel's vertices are in no edge, this one first; they are left out",
                                        std::ranges::count(used, char(0))),
                            {},
                            Severity::note});
    }
}

void find_short_edges(const Pattern& pattern, const Cloth& cloth, double edge_length, std::vector<Finding>& findings)
{
    const OutlineSamples* shortest = nullptr;
    int count = 0;
    for (const OutlineSamples& side : cloth.outline) {
        if (side.panel >= int(pattern.panels.size()) || side.length >= short_edge * edge_length) continue;
        ++count;
        if (!shortest || side.length < shortest->length) shortest = &side;
    }
    if (!shortest) return;
    findings.push_back({"short_edge",
                        pattern.place(fmt::format("{}.edges[{}]", panel_key(pattern, shortest->panel), shortest->edge)),
                        fmt::format("{:.2g} mm long, with {} edges in all shorter than a fifth of garment.resolution; "
                                    "triangles there are as small",
                                    1000 * shortest->length, count),
                        "where the shape allows it, join the edge with its neighbour", Severity::note});
}

void find_odd_size(const Pattern& pattern, std::vector<Finding>& findings)
{
    double largest = 0;
    int panel = 0;
    for (int p = 0; p < int(pattern.panels.size()); ++p) {
        Vec2 low = pattern.panels[p].vertices.front(), high = low;
        for (const Vec2& vertex : pattern.panels[p].vertices) {
            low = low.cwiseMin(vertex);
            high = high.cwiseMax(vertex);
        }
        if ((high - low).maxCoeff() <= largest) continue;
        largest = (high - low).maxCoeff();
        panel = p;
    }
    if (largest >= doll_size) return;
    findings.push_back({"unit", pattern.place(panel_key(pattern, panel) + ".vertices"),
                        fmt::format("the largest panel of the pattern measures {:.3g} m", largest),
                        "see properties.units_in_meter: " + unit_meanings(largest * pattern.units_in_meter)});
}

}  // namespace

std::vector<Finding> examine_pattern(const Pattern& pattern, const Cloth& cloth, double edge_length)
{
    std::vector<Finding> findings = examine_seams(pattern, cloth);
    find_loose_panels(pattern, findings);
    find_unused_corners(pattern, findings);
    find_short_edges(pattern, cloth, edge_length, findings);
    find_odd_size(pattern, findings);
    return findings;
}

}  // namespace selvage
