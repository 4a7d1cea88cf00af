#include "host/scene/plan_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "host/scene/plan.hpp"

namespace selvage {
namespace {

double mebibytes(std::size_t bytes) { return double(bytes) / (1 << 20); }

const char* list_of(const Finding& finding) { return finding.severity == Severity::note ? "notes" : "warnings"; }

std::string plan_json(const Scene& scene, const SceneModel& model, const RunPlan& plan)
{
    nlohmann::ordered_json json;
    json["scene"] = scene.name;
    json["summary"] = scene.summary;
    json["parameters"] = scene.parameters;
    json["fabrics"] = nlohmann::json::array();
    for (const auto& [name, fabric] : model.cloth_model.fabrics)
        json["fabrics"].push_back({{"name", name}, {"source", fabric.source}});
    json["vertices"] = model.cloth_model.cloth.positions.size();
    json["triangles"] = model.cloth_model.cloth.faces.size();
    json["coarser_levels"] = model.cloth_model.coarser.size();
    json["phases"] = nlohmann::json::array();
    for (const PhasePlan& phase : plan.phases) {
        nlohmann::ordered_json entry{{"name", word_of(phase.stage)},
                                     {"field_bytes", phase.field_bytes},
                                     {"solver_bytes", phase.solver_bytes},
                                     {"launches", nlohmann::json::array()}};
        for (const PlannedLaunch& launch : phase.launches)
            entry["launches"].push_back(
                {{"name", launch.name}, {"per", launch.items}, {"items", launch.count}, {"bytes", launch.bytes}});
        json["phases"].push_back(entry);
    }
    json["integrators"] = plan.integrators;
    json["active"] = plan.active;
    json["skipped"] = nlohmann::json::array();
    for (const SkippedFeature& skipped : plan.skipped)
        json["skipped"].push_back({{"name", skipped.name}, {"reason", skipped.reason}});
    json["embree"] = plan.embree;
    json["memory"] = nlohmann::json::array();
    for (const MemoryPart& part : plan.memory) json["memory"].push_back({{"name", part.name}, {"bytes", part.bytes}});
    json["peak_bytes"] = plan.peak_bytes;
    json["warnings"] = json["notes"] = nlohmann::json::array();
    for (const Finding& finding : model.findings) json[list_of(finding)].push_back(describe(finding));
    return json.dump(2) + "\n";
}

std::string plan_text(const Scene& scene, const SceneModel& model, const RunPlan& plan)
{
    std::string text =
        fmt::format("{}: {} vertices, {} triangles in {} panels, {} seams, {} bodies, {} coarser levels\n", scene.name,
                    model.cloth_model.cloth.positions.size(), model.cloth_model.cloth.faces.size(),
                    model.cloth_model.cloth.panels.size(), model.cloth_model.cloth.seams.size(),
                    model.cloth_model.bodies.size(), model.cloth_model.coarser.size());
    if (!scene.summary.empty()) text += scene.summary + "\n";
    for (const auto& [name, fabric] : model.cloth_model.fabrics)
        text += fmt::format("fabric {}{}\n", name, fabric.source.empty() ? "" : ": " + fabric.source);
    if (!scene.parameters.empty()) text += fmt::format("commonly overridden: {}\n", fmt::join(scene.parameters, ", "));
    for (const PhasePlan& phase : plan.phases) {
        text += fmt::format("\nphase {}: state {:.1f} MiB, linear solver about {:.1f} MiB\n", word_of(phase.stage),
                            mebibytes(phase.field_bytes), mebibytes(phase.solver_bytes));
        for (const PlannedLaunch& launch : phase.launches)
            text += fmt::format("  {:<14} {:>9} per {:<7} {:>9.2f} MiB\n", launch.name, launch.count, launch.items,
                                mebibytes(launch.bytes));
    }
    text += fmt::format("\nintegrators of the drape: {}\n", fmt::join(plan.integrators, ", then "));
    text += "\nskipped\n";
    for (const SkippedFeature& skipped : plan.skipped)
        text += fmt::format("  {:<14} {}\n", skipped.name, skipped.reason);
    text += fmt::format("\nmemory of the whole run: about {:.0f} MiB\n", mebibytes(plan.peak_bytes));
    for (const MemoryPart& part : plan.memory)
        text += fmt::format("  {:<17} {:>9.1f} MiB\n", part.name, mebibytes(part.bytes));
    for (const Finding& finding : model.findings)
        text += fmt::format("{}: {}\n", word_of(finding.severity), describe(finding));
    return text;
}

}  // namespace

std::string describe_plan(const Scene& scene, bool json)
{
    const SceneModel model = build_scene_model(scene);
    const RunPlan plan = make_plan(scene, model);
    check_memory(scene, plan);
    return json ? plan_json(scene, model, plan) : plan_text(scene, model, plan);
}

}  // namespace selvage
