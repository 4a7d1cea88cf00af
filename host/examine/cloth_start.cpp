#include "host/examine/cloth_start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "host/collision/body_query.hpp"
#include "host/examine/cloth_place.hpp"
#include "host/examine/file_mesh.hpp"
#include "host/examine/mesh_edges.hpp"
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

// Signed distances of points to bodies [m]; infinite for those outside the boxes of all of them, but for planes.
std::vector<double> distances_to(const std::vector<Body>& bodies, const std::vector<Vec3>& points)
{
    std::vector<double> distances(points.size(), std::numeric_limits<double>::infinity());
    std::vector<Box> boxes;
    bool reaches_all = false;
    Box all;
    for (const Body& body : bodies) {
        boxes.emplace_back();
        // A closed form rises above its tessellation by little.
        const Vec3 margin = Vec3::Constant(body.kind == Body::Kind::mesh ? 0 : 0.1 * body.radius);
        for (const Vec3& x : body.mesh.vertices) boxes.back().extend(Box(x - margin, x + margin));
        all.extend(boxes.back());
        reaches_all = reaches_all || body.kind == Body::Kind::plane;
    }
    std::vector<int> near;
    std::vector<Vec3> near_points;
    for (int v = 0; v < int(points.size()); ++v)
        if (reaches_all || std::ranges::any_of(boxes, [&](const Box& box) { return box.contains(points[v]); })) {
            near.push_back(v);
            near_points.push_back(points[v]);
        }
    if (near.empty()) return distances;
    const std::vector<double> found = BodyQuery(bodies, all).signed_distances(near_points);
    for (std::size_t k = 0; k < near.size(); ++k) distances[near[k]] = found[k];
    return distances;
}

// Faces with a corner inside a body.
Finding find_penetrations(const ClothModel& model)
{
    const Cloth& cloth = model.cloth;
    Finding finding{"penetration", {}, {}};
    if (model.bodies.empty()) return finding;
    const std::vector<double> distance = distances_to(model.bodies, cloth.positions);
    for (int f = 0; f < int(cloth.faces.size()); ++f)
        if (std::ranges::any_of(cloth.faces[f], [&](int v) { return distance[v] < 0; })) finding.faces.push_back(f);
    const auto count = std::ranges::count_if(distance, [](double d) { return d < 0; });
    if (count == 0) return finding;
    finding.text = fmt::format("{} of {} vertices start inside a body, the deepest by {:.1f} mm", count,
                               cloth.positions.size(), -1000 * std::ranges::min(distance));
    finding.way_on = "move the cloth or the body apart";
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

// The faces with one vertex for all that seams join at one place.
std::vector<Face> joined_faces(const Cloth& cloth)
{
    JoinedSets sets(cloth.positions.size());
    for (const auto& [a, b] : cloth.seam_pairs)
        if (cloth.positions[a] == cloth.positions[b]) sets.join(a, b);
    std::vector<Face> faces = cloth.faces;
    for (Face& face : faces)
        for (int& v : face) v = sets.root(v);
    return faces;
}

Finding find_crossed_cloth(const Cloth& cloth)
{
    Finding finding{"self_intersection", {}, {}};
    finding.pairs = self_intersections(cloth.positions, joined_faces(cloth));
    note_faces(finding, true);
    if (finding.pairs.empty()) return finding;
    const auto [a, b] = finding.pairs.front();
    const Vec3& at = cloth.positions[cloth.faces[a][0]];
    finding.text = fmt::format("{} pairs of the cloth's triangles intersect at the start, the first {} and {}{}",
                               finding.pairs.size(), a, b, at_text(at));
    finding.way_on = "part the layers: cloth that starts through itself may stay so";
    return finding;
}

// The faces of a mesh whose boxes meet a box.
std::vector<int> faces_in(const TriangleMesh& mesh, const Box& box)
{
    std::vector<int> near;
    for (int f = 0; f < int(mesh.faces.size()); ++f) {
        Box of_face;
        for (const int v : mesh.faces[f]) of_face.extend(mesh.vertices[v]);
        if (of_face.intersects(box)) near.push_back(f);
    }
    return near;
}

Finding find_crossed_body(const Cloth& cloth, const Body& body)
{
    Finding finding{"body_intersection", {}, {}};
    const std::vector<int> near = faces_in(body.mesh, box_of(cloth.positions));
    if (near.empty()) return finding;
    TriangleMesh part{body.mesh.vertices, {}, {}};
    for (const int f : near) part.faces.push_back(body.mesh.faces[f]);
    finding.pairs = mutual_intersections(cloth.positions, cloth.faces, part);
    for (auto& pair : finding.pairs) pair[1] = near[pair[1]];
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

}  // namespace

std::vector<Finding> examine_start(const ClothModel& model, const Scene& scene)
{
    std::vector<Finding> findings{find_bad_triangles(model.cloth)};
    if (scene.contact.self) findings.push_back(find_crossed_cloth(model.cloth));
    if (scene.contact.body) {
        findings.push_back(find_penetrations(model));
        for (const Body& body : model.bodies) findings.push_back(find_crossed_body(model.cloth, body));
    }
    std::erase_if(findings, [](const Finding& finding) { return finding.text.empty(); });
    append_findings(findings, examine_place(model, scene));
    return findings;
}

}  // namespace selvage
