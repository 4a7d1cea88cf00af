#include "host/examine/seams.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/SVD>

#include "host/garment/seam.hpp"

namespace selvage {
namespace {

struct SeamTuning {
    // Correlation below which a seam counts as crossed [1]. Seams of real garments lie between 0.2 and 1.
    static constexpr double crossed_correlation = -0.15;
    // Second singular value and trace [1], see is_mirrored. Of 252 panels of 36 real patterns none has a second
    // singular value above 0.007 with the sign of a mirror image, or a trace below 0.35. Of the same panels mirrored
    // one at a time these limits find 237; the others are narrow godets. Bands and sleeves in one piece have values
    // about 0.
    static constexpr double mirrored_width = 0.08, least_trace = -0.1;
    // Lengths of the sides of a seam, the longer over the shorter [1]. Sleeve caps are eased in by up to 1.1, skirts
    // are gathered into waistbands by up to 2.2 in real patterns; frills take 3.
    static constexpr double gathered = 1.25, overfull = 3;
    // Distance of the sides of a seam as placed, over the larger panel's extent [1]: 1.7 at most in real patterns.
    static constexpr double far_apart = 5;
    static constexpr std::size_t most_told = 8;  // findings of one kind; the rest is counted
};

// A seam with its two sides as rows of paired vertices.
struct SewnSides {
    int stitch = 0;
    StitchSide a, b;
    double length_a = 0, length_b = 0;
    std::vector<int> vertices_a, vertices_b;
    bool crosses = false;

    double ratio() const { return std::max(length_a, length_b) / std::min(length_a, length_b); }
};

std::vector<SewnSides> sewn_sides(const Pattern& pattern, const Cloth& cloth)
{
    std::vector<SewnSides> all;
    for (int index = 0; index < int(pattern.stitches.size()); ++index) {
        const PatternStitch& stitch = pattern.stitches[index];
        const Seam& seam = cloth.seams[index];
        SewnSides sides{index, stitch.a, stitch.b, seam.length_a, seam.length_b, cloth.outline[seam.side_a].vertices,
                        {},    false};
        sides.vertices_b = cloth.outline[seam.side_b].vertices;
        if (!stitch.same_direction) std::reverse(sides.vertices_b.begin(), sides.vertices_b.end());
        all.push_back(std::move(sides));
    }
    return all;
}

// Returns the correlation of the positions of paired points about their means: 1 if one side is a translated copy of
// the other, -1 if it runs in the opposite direction. Distances of the pairs would not show the direction, since the
// distance between the panels outweighs it.
double correlation(const Cloth& cloth, const std::vector<int>& a, const std::vector<int>& b, bool reversed)
{
    Vec3 middle_a = Vec3::Zero(), middle_b = Vec3::Zero();
    for (std::size_t i = 0; i < a.size(); ++i) {
        middle_a += cloth.positions[a[i]] / double(a.size());
        middle_b += cloth.positions[b[i]] / double(a.size());
    }
    double product = 0, square_a = 0, square_b = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Vec3 arm_a = cloth.positions[a[i]] - middle_a;
        const Vec3 arm_b = cloth.positions[b[reversed ? b.size() - 1 - i : i]] - middle_b;
        product += arm_a.dot(arm_b);
        square_a += arm_a.squaredNorm();
        square_b += arm_b.squaredNorm();
    }
    return product / std::sqrt(square_a * square_b);
}

// The corners of all panels, joined as some seams join them.
class JoinedCorners {
public:
    JoinedCorners(const std::vector<SewnSides>& seams, int left_out)
    {
        for (const SewnSides& seam : seams) {
            if (seam.stitch == left_out) continue;
            join(seam.vertices_a.front(), seam.vertices_b.front());
            join(seam.vertices_a.back(), seam.vertices_b.back());
        }
    }

    bool joined(int a, int b) { return root(a) == root(b); }

private:
    int root(int vertex)
    {
        const auto found = parent_.find(vertex);
        if (found == parent_.end()) return vertex;
        return found->second = root(found->second);
    }
    void join(int a, int b)
    {
        if (root(a) != root(b)) parent_[root(a)] = root(b);
    }

    std::map<int, int> parent_;
};

// As placed the seam runs in opposite directions on both sides, and no other seams join its ends as it does. A short
// seam around a corner of the body may look crossed, but its neighbours then meet it as it is.
bool crosses(const Cloth& cloth, const std::vector<SewnSides>& seams, const SewnSides& seam)
{
    const std::vector<int>&a = seam.vertices_a, &b = seam.vertices_b;
    if (!(correlation(cloth, a, b, false) < SeamTuning::crossed_correlation)) return false;
    if (correlation(cloth, a, b, true) <= 0) return false;
    JoinedCorners others(seams, seam.stitch);
    return !others.joined(a.front(), b.front()) && !others.joined(a.back(), b.back());
}

// Returns a panel's name and which way round its outline is drawn.
std::string drawn(const Pattern& pattern, const Cloth& cloth, int panel)
{
    return fmt::format("`{}` ({})", pattern.panels[panel].name,
                       cloth.panels[panel].reversed ? "drawn clockwise" : "drawn counter-clockwise");
}

void tell_crossed(const Pattern& pattern, const Cloth& cloth, const SewnSides& seam, std::vector<Finding>& findings)
{
    const bool turned = pattern.stitches[seam.stitch].same_direction;
    std::string way_on =
        std::string("to turn the seam, ") + (turned ? "remove" : "add") + " the stitch's third element `right_wrong`";
    if (cloth.panels[seam.a.panel].reversed != cloth.panels[seam.b.panel].reversed)
        way_on += fmt::format(", or draw the outlines of {} and {} the same way round",
                              drawn(pattern, cloth, seam.a.panel), drawn(pattern, cloth, seam.b.panel));
    findings.push_back({"seam", pattern.place(stitch_key(seam.stitch)),
                        side_name(pattern, seam.a) + " and " + side_name(pattern, seam.b) +
                            " cross when sewn, for as placed they run in opposite directions",
                        way_on});
}

// The sewn points of one panel and those of its neighbours that they are sewn to.
struct SewnPanel {
    std::vector<Vec2> own;      // panel coordinates
    std::vector<Vec3> partner;  // as placed
    std::set<int> neighbours;
    bool told = false;  // a seam of it crosses, or a neighbour has been told to be mirrored
};

std::vector<SewnPanel> sewn_panels(const Pattern& pattern, const Cloth& cloth, const std::vector<SewnSides>& seams)
{
    std::vector<SewnPanel> panels(pattern.panels.size());
    const auto add = [&](const StitchSide& side, const std::vector<int>& own, const std::vector<int>& partner,
                         int neighbour) {
        SewnPanel& panel = panels[side.panel];
        panel.neighbours.insert(neighbour);
        for (const int v : own) panel.own.push_back(cloth.panel_coordinates[v]);
        for (const int v : partner) panel.partner.push_back(cloth.positions[v]);
    };
    for (const SewnSides& seam : seams) {
        if (seam.crosses) panels[seam.a.panel].told = panels[seam.b.panel].told = true;
        if (seam.a.panel == seam.b.panel) continue;
        add(seam.a, seam.vertices_a, seam.vertices_b, seam.b.panel);
        add(seam.b, seam.vertices_b, seam.vertices_a, seam.a.panel);
    }
    return panels;
}

// Whether the points that a panel is sewn to, seen along its normal, lie as in a mirror image of its own outline. The
// panel would have to be turned over to be sewn.
bool is_mirrored(const SewnPanel& panel, const Mat3& rotation)
{
    if (panel.own.empty()) return false;
    Vec2 own_middle = Vec2::Zero();
    Vec3 partner_middle = Vec3::Zero();
    for (std::size_t i = 0; i < panel.own.size(); ++i) {
        own_middle += panel.own[i] / double(panel.own.size());
        partner_middle += panel.partner[i] / double(panel.own.size());
    }
    Mat2 product = Mat2::Zero();
    double own_square = 0, partner_square = 0;
    for (std::size_t i = 0; i < panel.own.size(); ++i) {
        const Vec2 own = panel.own[i] - own_middle;
        const Vec3 partner = rotation.transpose() * (panel.partner[i] - partner_middle);
        product += own * partner.head<2>().transpose();
        own_square += own.squaredNorm();
        partner_square += partner.squaredNorm();
    }
    if (!(own_square * partner_square > 0)) return false;
    product /= std::sqrt(own_square * partner_square);
    const Vec2 sizes = Eigen::JacobiSVD<Mat2>(product).singularValues();
    return (product.determinant() < 0 && sizes.y() > SeamTuning::mirrored_width) ||
           product.trace() < SeamTuning::least_trace;
}

void find_mirrored(const Pattern& pattern, const Cloth& cloth, const std::vector<SewnSides>& seams,
                   std::vector<Finding>& findings)
{
    std::vector<SewnPanel> panels = sewn_panels(pattern, cloth, seams);
    std::vector<int> mirrored;
    for (int p = 0; p < int(panels.size()); ++p)
        if (!panels[p].told && is_mirrored(panels[p], pattern.panels[p].rotation)) mirrored.push_back(p);
    // The panel with most neighbours is the one that does not fit them.
    std::ranges::stable_sort(mirrored, std::greater{}, [&](int p) { return panels[p].neighbours.size(); });
    for (const int p : mirrored) {
        if (panels[p].told) continue;
        std::vector<std::string> names;
        for (const int neighbour : panels[p].neighbours) {
            names.push_back(drawn(pattern, cloth, neighbour));
            panels[neighbour].told = true;
        }
        findings.push_back({"side", pattern.place("pattern.panels." + pattern.panels[p].name),
                            fmt::format("{} is sewn mirrored to {}: as placed, the edges that are sewn together lie on "
                                        "opposite sides, and the panels would cross",
                                        drawn(pattern, cloth, p), fmt::join(names, ", ")),
                            "draw the outline of one of them the other way round, turn it over with `rotation`, or "
                            "exchange the edges that are stitched"});
    }
}

std::string sides_text(const Pattern& pattern, const SewnSides& seam)
{
    return fmt::format("{} is {:.3g} m long and {} {:.3g} m ({:.3g} to 1)", side_name(pattern, seam.a), seam.length_a,
                       side_name(pattern, seam.b), seam.length_b, seam.ratio());
}

void find_unlike_lengths(const Pattern& pattern, const std::vector<SewnSides>& seams, std::vector<Finding>& findings)
{
    std::vector<const SewnSides*> overfull, gathered;
    for (const SewnSides& seam : seams) {
        if (seam.ratio() > SeamTuning::overfull)
            overfull.push_back(&seam);
        else if (seam.ratio() > SeamTuning::gathered)
            gathered.push_back(&seam);
    }
    std::ranges::stable_sort(overfull, std::greater{}, [](const SewnSides* seam) { return seam->ratio(); });
    for (std::size_t k = 0; k < std::min(overfull.size(), SeamTuning::most_told); ++k) {
        const bool more = k + 1 == SeamTuning::most_told && overfull.size() > k + 1;
        findings.push_back({"seam_length", pattern.place(stitch_key(overfull[k]->stitch)),
                            sides_text(pattern, *overfull[k]) + ", more than the fullest frill" +
                                (more ? fmt::format("; so are {} more seams", overfull.size() - k - 1) : ""),
                            "check that the stitch names the right edges and that both panels have the same unit"});
    }
    if (gathered.empty()) return;
    const SewnSides& most =
        **std::ranges::max_element(gathered, {}, [](const SewnSides* seam) { return seam->ratio(); });
    findings.push_back({"seam_length",
                        pattern.place(stitch_key(most.stitch)),
                        fmt::format("{}: the longer side will be gathered, as in {} seams of the pattern",
                                    sides_text(pattern, most), gathered.size()),
                        {},
                        Severity::note});
}

double extent(const Cloth& cloth, int panel)
{
    const ClothPanel& p = cloth.panels[panel];
    Vec2 low = cloth.panel_coordinates[p.first_vertex], high = low;
    for (int v = p.first_vertex; v < p.first_vertex + p.vertex_count; ++v) {
        low = low.cwiseMin(cloth.panel_coordinates[v]);
        high = high.cwiseMax(cloth.panel_coordinates[v]);
    }
    return (high - low).norm();
}

void find_far_seams(const Pattern& pattern, const Cloth& cloth, const std::vector<SewnSides>& seams,
                    std::vector<Finding>& findings)
{
    std::vector<double> extents;
    for (int p = 0; p < int(pattern.panels.size()); ++p) extents.push_back(extent(cloth, p));
    std::vector<char> told(pattern.panels.size());
    for (const SewnSides& seam : seams) {
        Vec3 way = Vec3::Zero();
        for (std::size_t i = 0; i < seam.vertices_a.size(); ++i)
            way += (cloth.positions[seam.vertices_b[i]] - cloth.positions[seam.vertices_a[i]]) /
                   double(seam.vertices_a.size());
        const double most = SeamTuning::far_apart * std::max(extents[seam.a.panel], extents[seam.b.panel]);
        if (way.norm() <= most || told[seam.a.panel] || told[seam.b.panel]) continue;
        told[seam.a.panel] = told[seam.b.panel] = 1;
        findings.push_back({"placement", pattern.place("pattern.panels." + pattern.panels[seam.b.panel].name),
                            fmt::format("the panel starts {:.3g} m away from `{}`, to which {} sews it", way.norm(),
                                        pattern.panels[seam.a.panel].name, stitch_key(seam.stitch)),
                            "check its `translation`, which has the pattern's unit"});
    }
}

}  // namespace

std::vector<Finding> examine_seams(const Pattern& pattern, const Cloth& cloth)
{
    std::vector<Finding> findings;
    std::vector<SewnSides> seams = sewn_sides(pattern, cloth);
    for (SewnSides& seam : seams) seam.crosses = crosses(cloth, seams, seam);
    for (const SewnSides& seam : seams)
        if (seam.crosses) tell_crossed(pattern, cloth, seam, findings);
    find_mirrored(pattern, cloth, seams, findings);
    find_unlike_lengths(pattern, seams, findings);
    find_far_seams(pattern, cloth, seams, findings);
    return findings;
}

}  // namespace selvage
