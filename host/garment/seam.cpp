#include "host/garment/seam.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "host/garment/outline.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

// Correlation below which a seam counts as crossed [1]. Seams of real garments lie between 0.2 and 1.
constexpr double crossed_correlation = -0.15;

std::string stitch_key(int stitch) { return "pattern.stitches[" + std::to_string(stitch) + "]"; }

std::string side_name(const Pattern& pattern, const StitchSide& side)
{
    return pattern.panels[side.panel].name + ".edges[" + std::to_string(side.edge) + "]";
}

// Returns the correlation of the positions of paired points about their means: 1 if one side is a translated copy of
// the other, -1 if it runs in the opposite direction. Distances of the pairs would not show the direction, since the
// distance between the panels outweighs it.
double correlation(const Cloth& cloth, const std::vector<int>& a, const std::vector<int>& b, bool same_direction)
{
    Vec3 middle_a = Vec3::Zero(), middle_b = Vec3::Zero();
    for (std::size_t i = 0; i < a.size(); ++i) {
        middle_a += cloth.positions[a[i]] / double(a.size());
        middle_b += cloth.positions[b[i]] / double(a.size());
    }
    double product = 0, square_a = 0, square_b = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Vec3 arm_a = cloth.positions[a[i]] - middle_a;
        const Vec3 arm_b = cloth.positions[b[same_direction ? i : b.size() - 1 - i]] - middle_b;
        product += arm_a.dot(arm_b);
        square_a += arm_a.squaredNorm();
        square_b += arm_b.squaredNorm();
    }
    return product / std::sqrt(square_a * square_b);
}

void warn_if_crossed(const Pattern& pattern, int index, const OutlineSamples& a, const OutlineSamples& b, Cloth& cloth)
{
    const PatternStitch& stitch = pattern.stitches[index];
    const double given = correlation(cloth, a.vertices, b.vertices, stitch.same_direction);
    if (!(given < crossed_correlation) || correlation(cloth, a.vertices, b.vertices, !stitch.same_direction) <= 0)
        return;
    cloth.findings.push_back({"seam", pattern.place(stitch_key(index)),
                              side_name(pattern, stitch.a) + " and " + side_name(pattern, stitch.b) +
                                  " cross when sewn, for as placed they run in opposite directions",
                              std::string("to turn the seam, ") + (stitch.same_direction ? "remove" : "add") +
                                  " the stitch's third element `right_wrong`"});
}

}  // namespace

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
        seam.first_pair = int(cloth.seam_pairs.size());
        for (std::size_t i = 0; i < a.vertices.size(); ++i) {
            const int first = a.vertices[i], second = b.vertices[stitch.same_direction ? i : b.vertices.size() - 1 - i];
            if (first == second || !known.insert({std::min(first, second), std::max(first, second)}).second) continue;
            cloth.seam_pairs.push_back({first, second});
        }
        seam.pair_count = int(cloth.seam_pairs.size()) - seam.first_pair;
        cloth.seams.push_back(seam);
        warn_if_crossed(pattern, index, a, b, cloth);
    }
}

}  // namespace selvage
