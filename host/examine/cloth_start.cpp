#include "host/examine/cloth_start.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "host/collision/body_query.hpp"
#include "host/mesh/self_intersections.hpp"

namespace selvage {
namespace {

constexpr double smallest_good_angle = 10;  // [degrees]; below it a triangle's strain is read badly

double smallest_angle(const Cloth& cloth, int face)
{
    double smallest = 180;
    for (int k = 0; k < 3; ++k) {
        const Vec2& at = cloth.panel_coordinates[cloth.faces[face][k]];
        const Vec2 a = cloth.panel_coordinates[cloth.faces[face][(k + 1) % 3]] - at;
        const Vec2 b = cloth.panel_coordinates[cloth.faces[face][(k + 2) % 3]] - at;
        smallest = std::min(smallest, std::acos(std::clamp(a.dot(b) / (a.norm() * b.norm()), -1.0, 1.0)));
    }
    return smallest * 180 / std::numbers::pi;
}

// Faces with a corner inside a body.
Finding find_penetrations(const ClothModel& model, const Box& reach)
{
    const Cloth& cloth = model.cloth;
    Finding finding{"penetration", {}, {}};
    if (model.bodies.empty()) return finding;
    const BodyQuery query(model.bodies, reach);
    std::vector<char> inside(cloth.positions.size());
    double deepest = 0;
    for (std::size_t v = 0; v < cloth.positions.size(); ++v) {
        const BodyGap gap = query.measure(cloth.positions[v].data(), 1, 1);
        inside[v] = gap.vertices_inside > 0;
        deepest = std::max(deepest, gap.max_penetration_m);
    }
    for (int f = 0; f < int(cloth.faces.size()); ++f)
        if (std::any_of(cloth.faces[f].begin(), cloth.faces[f].end(), [&](int v) { return inside[v]; }))
            finding.faces.push_back(f);
    const auto count = std::count(inside.begin(), inside.end(), char(1));
    if (count > 0)
        finding.text = fmt::format("{} of {} vertices start inside a body, the deepest by {:.1f} mm", count,
                                   cloth.positions.size(), 1000 * deepest);
    return finding;
}

// The cloth's faces that occur in pairs, sorted.
void note_faces(Finding& finding, bool both)
{
    for (const auto& [a, b] : finding.pairs) {
        finding.faces.push_back(a);
        if (both) finding.faces.push_back(b);
    }
    std::sort(finding.faces.begin(), finding.faces.end());
    finding.faces.erase(std::unique(finding.faces.begin(), finding.faces.end()), finding.faces.end());
}

Finding find_crossed_cloth(const Cloth& cloth)
{
    Finding finding{"self_intersection", {}, {}};
    finding.pairs = self_intersections(cloth.positions, cloth.faces);
    note_faces(finding, true);
    if (!finding.pairs.empty())
        finding.text = fmt::format("{} pairs of the cloth's triangles intersect, the first {} and {}",
                                   finding.pairs.size(), finding.pairs.front()[0], finding.pairs.front()[1]);
    return finding;
}

Finding find_crossed_body(const Cloth& cloth, const Body& body)
{
    Finding finding{"body_intersection", {}, {}};
    finding.pairs = mutual_intersections(cloth.positions, cloth.faces, body.mesh);
    note_faces(finding, false);
    if (!finding.pairs.empty())
        finding.text = fmt::format("{} triangles of the cloth intersect the body `{}`, in {} pairs; the first is {}",
                                   finding.faces.size(), body.name, finding.pairs.size(), finding.pairs.front()[0]);
    return finding;
}

Finding find_bad_triangles(const Cloth& cloth)
{
    Finding finding{"triangle", {}, {}};
    double worst = 180;
    for (int f = 0; f < int(cloth.faces.size()); ++f) {
        const double angle = smallest_angle(cloth, f);
        worst = std::min(worst, angle);
        if (angle < smallest_good_angle) finding.faces.push_back(f);
    }
    if (!finding.faces.empty())
        finding.text = fmt::format("{} triangles have an angle below {} degrees, the smallest {:.1f}",
                                   finding.faces.size(), smallest_good_angle, worst);
    return finding;
}

Finding find_odd_size(const Cloth& cloth)
{
    Finding finding{"unit", {}, {}};
    Vec3 low = cloth.positions.front(), high = low;
    for (const Vec3& x : cloth.positions) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    const double size = (high - low).norm();
    if (size > 20 || size < 0.02) finding.text = fmt::format("the cloth is {:.3g} m across: is its unit right?", size);
    return finding;
}

}  // namespace

std::vector<Finding> examine_start(const ClothModel& model, const Box& reach)
{
    std::vector<Finding> findings{find_penetrations(model, reach), find_crossed_cloth(model.cloth),
                                  find_bad_triangles(model.cloth), find_odd_size(model.cloth)};
    for (const Body& body : model.bodies) findings.push_back(find_crossed_body(model.cloth, body));
    std::erase_if(findings, [](const Finding& finding) { return finding.text.empty(); });
    return findings;
}

}  // namespace selvage
