#include "host/scene/diagnose.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/model/cloth_model.hpp"
#include "host/render/picture.hpp"
#include "host/scene/plan.hpp"

namespace selvage {
namespace {

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
    const std::vector<Finding>& findings = model.findings;
    if (!picture_path.empty()) draw(model.cloth_model, findings, picture_path);

    Diagnosis diagnosis;
    diagnosis.clean = std::ranges::none_of(findings, [](const Finding& f) { return f.severity != Severity::note; });
    nlohmann::ordered_json json{{"scene", scene.name}, {"clean", diagnosis.clean}};
    json["findings"] = nlohmann::json::array();
    for (const Finding& finding : findings) {
        diagnosis.text += fmt::format("{}: {}: {}\n", word_of(finding.severity), finding.kind, describe(finding));
        json["findings"].push_back({{"kind", finding.kind},
                                    {"severity", word_of(finding.severity)},
                                    {"text", describe(finding)},
                                    {"triangles", finding.faces}});
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
