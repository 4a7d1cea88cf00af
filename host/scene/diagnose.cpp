#include "host/scene/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/collision/body_query.hpp"
#include "host/mesh/self_intersections.hpp"
#include "host/model/body.hpp"
#include "host/model/cloth_model.hpp"
#include "host/render/picture.hpp"
#include "host/scene/plan.hpp"

namespace selvage {
namespace {

constexpr double smallest_good_angle = 10;  // [degrees]; below it a triangle's strain is read badly

struct Finding {
    std::string kind, text;
    std::vector<int> faces;                    ///< Of the cloth that are involved, for the picture.
    std::vector<IntersectingPair> pairs = {};  ///< That intersect; of a body the second index is that of its face.
};

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
Finding find_penetrations(const ClothModel& model)
{
    const Cloth& cloth = model.cloth;
    Finding finding{"penetration", {}, {}};
    if (model.bodies.empty()) return finding;
    const BodyQuery query(model.bodies, cloth_reach(cloth));
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
    Finding finding{"self_intersection", {}, {}, self_intersections(cloth.positions, cloth.faces)};
    note_faces(finding, true);
    if (!finding.pairs.empty())
        finding.text = fmt::format("{} pairs of the cloth's triangles intersect, the first {} and {}",
                                   finding.pairs.size(), finding.pairs.front()[0], finding.pairs.front()[1]);
    return finding;
}

Finding find_crossed_body(const Cloth& cloth, const Body& body)
{
    Finding finding{"body_intersection", {}, {}, mutual_intersections(cloth.positions, cloth.faces, body.mesh)};
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

void draw(const ClothModel& model, const std::vector<Finding>& findings, const std::string& path)
{
    PictureCloth picture;
    picture.positions = model.cloth.positions;
    picture.faces = outward_faces(model.cloth);
    for (int p = 0; p < int(model.cloth.panels.size()); ++p)
        picture.face_panel.insert(picture.face_panel.end(), model.cloth.panels[p].face_count, p);
    for (const Finding& finding : findings)
        picture.highlighted_faces.insert(picture.highlighted_faces.end(), finding.faces.begin(), finding.faces.end());
    std::vector<TriangleMesh> bodies;
    for (const Body& body : model.bodies) bodies.push_back(body.mesh);
    PictureOptions options;
    if (!model.cloth.seam_pairs.empty()) options.views = PictureViews::front_and_back;
    write_png(path, render_picture(picture, bodies, options));
}

}  // namespace

Diagnosis diagnose_scene(const Scene& scene, const std::string& picture_path)
{
    const SceneModel model = build_scene_model(scene);
    check_memory(scene, make_plan(scene, model));
    std::vector<Finding> findings{find_penetrations(model.cloth_model), find_crossed_cloth(model.cloth_model.cloth),
                                  find_bad_triangles(model.cloth_model.cloth), find_odd_size(model.cloth_model.cloth)};
    for (const Body& body : model.cloth_model.bodies)
        findings.push_back(find_crossed_body(model.cloth_model.cloth, body));
    for (const std::string& warning : model.warnings) findings.push_back({"warning", warning, {}});
    std::erase_if(findings, [](const Finding& finding) { return finding.text.empty(); });
    if (!picture_path.empty()) draw(model.cloth_model, findings, picture_path);

    Diagnosis diagnosis;
    diagnosis.clean = findings.empty();
    nlohmann::ordered_json json{{"scene", scene.name}, {"clean", diagnosis.clean}};
    json["findings"] = nlohmann::json::array();
    for (const Finding& finding : findings) {
        diagnosis.text += finding.kind + ": " + finding.text + "\n";
        json["findings"].push_back({{"kind", finding.kind}, {"text", finding.text}, {"triangles", finding.faces}});
        if (!finding.pairs.empty()) json["findings"].back()["pairs"] = finding.pairs;
    }
    if (findings.empty())
        diagnosis.text = fmt::format("{}: nothing found ({} vertices, {} triangles, typical edge {:.1f} mm)\n",
                                     scene.name, model.cloth_model.cloth.positions.size(),
                                     model.cloth_model.cloth.faces.size(), 1000 * model.edge_length);
    diagnosis.json = json.dump(2) + "\n";
    return diagnosis;
}

}  // namespace selvage
