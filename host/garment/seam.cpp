#include "host/garment/seam.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "host/garment/outline.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

// Length of the longer side of a seam over that of the shorter [1]. A square of 30 cm was sewn along a whole side to
// ever shorter edges: at 8 the seam closes with nothing crossed, at 12 the cloth crosses itself, at 20 a gap of 2 cm
// stays.
constexpr double most_gathered = 20;

}  // namespace

std::string stitch_key(int stitch) { return "pattern.stitches[" + std::to_string(stitch) + "]"; }

std::string side_name(const Pattern& pattern, const StitchSide& side)
{
    return pattern.panels[side.panel].name + ".edges[" + std::to_string(side.edge) + "]";
}

void check_stitches(const Pattern& pattern)
{
    std::vector<std::vector<int>> stitch_of;
    for (const PatternPanel& panel : pattern.panels) stitch_of.emplace_back(panel.edges.size(), -1);
    for (int index = 0; index < int(pattern.stitches.size()); ++index)
        for (const StitchSide& side : {pattern.stitches[index].a, pattern.stitches[index].b}) {
            if (side.panel < 0 || side.panel >= int(pattern.panels.size()))
                throw InputError(pattern.place(stitch_key(index)), "panel " + std::to_string(side.panel),
                                 "an index into " + std::to_string(pattern.panels.size()) + " panels");
            const int edge_count = int(pattern.panels[side.panel].edges.size());
            if (side.edge < 0 || side.edge >= edge_count)
                throw InputError(pattern.place(stitch_key(index)), side_name(pattern, side),
                                 "one of the panel's " + std::to_string(edge_count) + " edges");
            int& earlier = stitch_of[side.panel][side.edge];
            if (earlier >= 0)
                throw InputError(
                    pattern.place(stitch_key(index)),
                    side_name(pattern, side) + ", which is also in stitches[" + std::to_string(earlier) + "]",
                    "an edge that is in no other stitch");
            earlier = index;
        }
}

void check_seam_lengths(const Pattern& pattern, const std::vector<std::vector<double>>& lengths)
{
    for (int index = 0; index < int(pattern.stitches.size()); ++index) {
        const StitchSide &a = pattern.stitches[index].a, &b = pattern.stitches[index].b;
        const double length_a = lengths[a.panel][a.edge], length_b = lengths[b.panel][b.edge];
        const double ratio = std::max(length_a, length_b) / std::min(length_a, length_b);
        if (ratio <= most_gathered) continue;
        throw InputError(pattern.place(stitch_key(index)),
                         fmt::format("a seam of {}, {:.3g} m long, to {}, {:.3g} m long: {:.3g} to 1",
                                     side_name(pattern, a), length_a, side_name(pattern, b), length_b, ratio),
                         fmt::format("sides of like length, at most {} to 1", most_gathered));
    }
}

std::vector<std::vector<int>> edge_segments(const Pattern& pattern, const std::vector<std::vector<double>>& lengths,
                                            double edge_length)
{
    std::vector<std::vector<int>> segments;
    for (const std::vector<double>& panel : lengths) {
        // A panel with only two edges has an area only if each of them is divided.
        const int fewest = panel.size() < 3 ? 2 : 1;
        segments.emplace_back();
        for (const double length : panel)
            segments.back().push_back(std::max(fewest, int(std::lround(length / edge_length))));
    }
    for (const PatternStitch& stitch : pattern.stitches) {
        int &a = segments[stitch.a.panel][stitch.a.edge], &b = segments[stitch.b.panel][stitch.b.edge];
        a = b = std::max(a, b);
    }
    return segments;
}

void join_seams(const Pattern& pattern, const std::vector<std::vector<int>>& side_of, Cloth& cloth)
{
    std::set<std::array<int, 2>> known;
    for (int index = 0; index < int(pattern.stitches.size()); ++index) {
        const PatternStitch& stitch = pattern.stitches[index];
        Seam seam;
        seam.side_a = side_of[stitch.a.panel][stitch.a.edge];
        seam.side_b = side_of[stitch.b.panel][stitch.b.edge];
        const OutlineSamples &a = cloth.outline[seam.side_a], &b = cloth.outline[seam.side_b];
        seam.length_a = a.length;
        seam.length_b = b.length;
        seam.place = pattern.place(stitch_key(index));
        seam.first_pair = int(cloth.seam_pairs.size());
        for (std::size_t i = 0; i < a.vertices.size(); ++i) {
            const int first = a.vertices[i], second = b.vertices[stitch.same_direction ? i : b.vertices.size() - 1 - i];
            if (first == second || !known.insert({std::min(first, second), std::max(first, second)}).second) continue;
            cloth.seam_pairs.push_back({first, second});
        }
        seam.pair_count = int(cloth.seam_pairs.size()) - seam.first_pair;
        cloth.seams.push_back(seam);
    }
}

}  // namespace selvage
