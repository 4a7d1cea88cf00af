#include "io/run/summary.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "io/atomic_file.hpp"
#include "io/errors.hpp"
#include "io/file_text.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json count(std::int64_t value) { return value >= 0 ? Json(value) : Json(nullptr); }

Json kernels_json(const RunSummary& summary)
{
    Json list = Json::array();
    for (const KernelUse& kernel : summary.kernels)
        list.push_back({{"name", kernel.name},
                        {"calls", kernel.calls},
                        {"seconds", number(kernel.seconds)},
                        {"processor_seconds", number(kernel.processor_seconds)},
                        {"items", kernel.items},
                        {"bytes", kernel.bytes}});
    return list;
}

Json skipped_json(const RunSummary& summary)
{
    Json list = Json::array();
    for (const SkippedPart& part : summary.skipped) list.push_back({{"name", part.name}, {"reason", part.reason}});
    return list;
}

Json panels_json(const RunSummary& summary)
{
    Json list = Json::array();
    for (const PanelFit& panel : summary.panels)
        list.push_back({{"name", panel.name},
                        {"area_error", number(panel.area_error)},
                        {"boundary_error", number(panel.boundary_error)}});
    return list;
}

Json coarse_json(const RunSummary& summary)
{
    Json list = Json::array();
    for (const CoarseUse& stage : summary.coarse_start)
        list.push_back({{"vertices", stage.vertices},
                        {"newton_iterations", stage.newton_iterations},
                        {"linear_iterations", stage.linear_iterations},
                        {"residual", number(stage.residual)},
                        {"seconds", number(stage.seconds)},
                        {"intersections", stage.intersections},
                        {"used", stage.used}});
    return list;
}

Json phases_json(const RunSummary& summary)
{
    Json phases = Json::object();
    for (const auto& [name, seconds] : summary.phases) phases[name] = number(seconds);
    return phases;
}

void add_state(Json& json, const RunSummary& summary)
{
    json["residual"] = number(summary.residual);
    json["energy"] = {{"membrane_J", number(summary.energy.membrane)},
                      {"bending_J", number(summary.energy.bending)},
                      {"gravity_J", number(summary.energy.gravity)},
                      {"contact_J", number(summary.energy.contact)},
                      {"kinetic_J", number(summary.energy.kinetic)}};
    json["stretch"] = {{"min", number(summary.stretch.min)},
                       {"max", number(summary.stretch.max)},
                       {"p99", number(summary.stretch.p99)},
                       {"largest", number(summary.stretch.largest)},
                       {"largest_s", number(summary.stretch.largest_time)},
                       {"largest_panel", summary.stretch.largest_panel},
                       {"largest_triangle", count(summary.stretch.largest_triangle)}};
    json["body"] = {{"max_penetration_m", number(summary.body_max_penetration)},
                    {"min_gap_m", number(summary.body_min_gap)},
                    {"intersections", count(summary.body_intersections)}};
    json["self"] = Json::object({{"intersections", count(summary.self_intersections)}});
    json["seams"] = {{"count", count(summary.seam_count)}, {"max_gap_m", number(summary.seam_max_gap)}};
    json["seams"]["open"] = Json::array();
    for (const RunSummary::SeamGap& seam : summary.open_seams)
        json["seams"]["open"].push_back(
            {{"sides", {seam.sides[0], seam.sides[1]}}, {"place", seam.place}, {"gap_m", number(seam.gap)}});
    json["panels"] = panels_json(summary);
}

// Steps to rest and those of explicit schemes are not to be solved: there is nothing to tell of them.
Json accuracy_json(const RunSummary& summary)
{
    const MotionAccuracy& a = summary.accuracy;
    const auto of = [](int steps, double value) { return steps > 0 ? number(value) : Json(); };
    return {{"aim", a.steps > 0 ? "motion" : "none"},
            {"tolerance", of(a.steps, summary.step_tolerance)},
            {"steps", a.steps},
            {"unsolved", a.unsolved},
            {"largest_left", of(a.steps, a.largest_left)},
            {"largest_left_s", of(a.steps, a.left_time)},
            {"mean_left", of(a.steps, a.sum_left / a.steps)},
            {"largest_time_error_m", of(a.estimates, a.largest_error)},
            {"largest_time_error_s", of(a.estimates, a.error_time)},
            {"mean_time_error_m", of(a.estimates, a.sum_error / a.estimates)}};
}

}  // namespace

std::optional<RunStatus> read_status(const std::string& path)
try {
    const Json json = Json::parse(read_file_text(path, "a summary"), nullptr, false);
    const auto status = json.is_object() ? json.find("status") : json.end();
    if (!json.is_object() || status == json.end() || !status->is_string()) return std::nullopt;
    return find_word<RunStatus>(status->get<std::string>());
} catch (const InputError&) {
    return std::nullopt;
}

std::string summary_json(const RunSummary& summary)
{
    Json json;
    json["status"] = word_of(summary.status);
    json["message"] = summary.message;
    json["scene"] = summary.scene;
    json["version"] = summary.version;
    json["threads"] = count(summary.threads);
    json["precision"] = summary.precision;
    json["vertices"] = count(summary.vertices);
    json["triangles"] = count(summary.triangles);
    json["steps"] = count(summary.steps);
    json["frames"] = count(summary.frames);
    json["newton_iterations"] = count(summary.newton_iterations);
    json["linear_iterations"] = count(summary.linear_iterations);
    json["simulated_s"] = number(summary.simulated_s);
    json["wall_s"] = number(summary.wall_s);
    json["stability"] = {{"asked_step_s", number(summary.stability.asked)},
                         {"limit_s", number(summary.stability.limit)},
                         {"taken_step_s", number(summary.stability.taken)}};
    json["accuracy"] = accuracy_json(summary);
    json["coarse_start"] = coarse_json(summary);
    json["phases"] = phases_json(summary);
    json["kernels"] = kernels_json(summary);
    json["integrators"] = summary.integrators;
    json["active"] = summary.active;
    json["skipped"] = skipped_json(summary);
    json["warnings"] = summary.warnings;
    json["peak_memory_bytes"] = count(summary.peak_memory_bytes);
    add_state(json, summary);
    // Names come from the user's files and may not be valid UTF-8, so invalid bytes are replaced.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_summary(const std::string& path, const RunSummary& summary)
{
    write_file_atomically(path, summary_json(summary));
}

}  // namespace selvage
