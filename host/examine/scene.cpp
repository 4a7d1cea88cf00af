#include "host/examine/scene.hpp"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "host/examine/body_pairs.hpp"
#include "host/examine/fabric.hpp"

namespace selvage {
namespace {

constexpr double strongest_gravity = 30;  // [m/s^2]; Jupiter has 25

// Returns the place of a key, or of the table around it if the key was not given.
InputPlace place_near(const Scene& scene, const std::string& key)
{
    InputPlace place = scene.place(key);
    if (place.line == 0 && !scene.places.contains(key)) place = scene.place(key.substr(0, key.rfind('.')));
    place.key = key;
    return place;
}

void find_odd_gravity(const Scene& scene, std::vector<Finding>& findings)
{
    const Vec3& g = scene.solver.gravity;
    const InputPlace place = place_near(scene, "solver.gravity");
    const std::string text = fmt::format("gravity of {:.4g} m/s^2", g.norm());
    if (g.norm() > strongest_gravity) {
        std::string hint = "that of the earth is 9.81 m/s^2";
        for (const auto& [factor, unit] : {std::pair(100, "cm/s^2"), std::pair(1000, "mm/s^2")})
            if (std::abs(g.norm() / factor - 9.81) < 0.2) hint += fmt::format(": is this one in {}?", unit);
        findings.push_back({"gravity", place, text, hint});
    } else if (g.norm() > 0 && g.z() > -0.5 * g.norm()) {
        findings.push_back({"gravity",
                            place,
                            fmt::format("{} along ({:.3g}, {:.3g}, {:.3g}), where z is up", text, g.x(), g.y(), g.z()),
                            {},
                            Severity::note});
    }
}

// Returns when a body's keyframes first change anything; nothing if they never do.
std::optional<double> first_change(const BodyScene& body)
{
    KeyframeScene last;
    last.time = 0;
    for (const KeyframeScene& key : body.keyframes) {
        const bool same_arms = std::isnan(key.arm_angle) || key.arm_angle == last.arm_angle;
        if (key.translation != last.translation || key.rotation != last.rotation || !same_arms || !key.mesh.empty())
            return last.time;
        last = key;
    }
    return std::nullopt;
}

void find_late_motions(const Scene& scene, std::vector<Finding>& findings)
{
    const Until until = scene.until();
    const double end = until.equilibrium ? scene.solver.max_time : until.time;
    const std::string of_run = fmt::format("the run, which ends at {:.4g} s ({})", end,
                                           until.equilibrium ? "solver.max_time" : "solver.until");
    const auto tell = [&](const std::string& key, const std::string& what, double time) {
        if (time < end) return;
        findings.push_back({"motion", place_near(scene, key),
                            fmt::format("{} begins at {:.4g} s, after {}", what, time, of_run),
                            "it has no effect: let it begin earlier or the run end later"});
    };
    const auto tell_rest = [&](const std::string& key, const std::string& what, double time) {
        if (time <= end) return;
        findings.push_back({"motion",
                            place_near(scene, key),
                            fmt::format("{} at {:.4g} s lies beyond {}", what, time, of_run),
                            {},
                            Severity::note});
    };
    for (std::size_t k = 0; k < scene.pin_motions.size(); ++k) {
        const PinMotionScene& motion = scene.pin_motions[k];
        const std::string key = fmt::format("pins.motion[{}]", k);
        tell(key + ".start", "the motion of pins", motion.start);
        if (motion.start < end) tell_rest(key + ".end", "the end of the motion", motion.end);
    }
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const BodyScene& body = scene.bodies[b];
        const std::string key = fmt::format("body[{}]", b);
        const std::optional<double> start = first_change(body);
        if (start) tell(key + ".keyframe[0].time", "the body's motion", *start);
        if (start && *start < end)
            tell_rest(fmt::format("{}.keyframe[{}].time", key, body.keyframes.size() - 1), "the last keyframe",
                      body.keyframes.back().time);
        if (!body.sequence.empty() && body.mesh.empty())
            tell(key + ".sequence_start", "the body's sequence", body.sequence_start);
    }
}

void find_wide_contact(const Scene& scene, const ClothModel& model, double edge_length, std::vector<Finding>& findings)
{
    if (!model.bodies.empty() && scene.contact.body && scene.contact.gap > edge_length)
        findings.push_back({"contact", place_near(scene, "contact.gap"),
                            fmt::format("{:.3g} m, more than the cloth's edges, which are {:.3g} m long: cloth floats "
                                        "that far above bodies and does not follow their shape",
                                        scene.contact.gap, edge_length),
                            "make it less than half of an edge"});
    for (const auto& [name, fabric] : model.fabrics)
        if (scene.contact.self && fabric.thickness > edge_length)
            findings.push_back({"contact", place_near(scene, "fabric." + name + ".thickness"),
                                fmt::format("{:.3g} m, more than the cloth's edges, which are {:.3g} m long: layers of "
                                            "cloth come nearer than that",
                                            fabric.thickness, edge_length),
                                "check its unit, or make the mesh coarser"});
}

void find_short_run(const Scene& scene, std::vector<Finding>& findings)
{
    const Until until = scene.until();
    if (until.equilibrium || until.time >= scene.solver.step) return;
    findings.push_back(
        {"until",
         place_near(scene, "solver.until"),
         fmt::format("{:.3g} s, less than one step of {:.3g} s (solver.step): the run is one shorter step", until.time,
                     scene.solver.step),
         {},
         Severity::note});
}

void find_empty_lists(const Scene& scene, std::vector<Finding>& findings)
{
    const auto tell = [&](const std::string& key, bool is_empty) {
        if (is_empty && scene.places.contains(key))
            findings.push_back(
                {"empty", scene.place(key), "an empty list, as if it were not there", {}, Severity::note});
    };
    tell("sheet", scene.sheets.empty());
    tell("body", scene.bodies.empty());
    tell("pins.motion", scene.pin_motions.empty());
    tell("pins.vertices", scene.pins.vertices.empty());
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
        tell(fmt::format("body[{}].keyframe", b), scene.bodies[b].keyframes.empty());
}

// Presets are as they are; what a scene says about a fabric is examined.
void examine_fabrics(const Scene& scene, const ClothModel& model, std::vector<Finding>& findings)
{
    for (const auto& [name, fabric] : model.fabrics) {
        if (!scene.places.contains("fabric." + name)) continue;
        for (Finding finding : examine_fabric(fabric, scene.place("fabric." + name))) {
            finding.place = place_near(scene, finding.place.key);
            findings.push_back(finding);
        }
    }
}

}  // namespace

std::vector<Finding> examine_scene(const Scene& scene, const ClothModel& model, double edge_length)
{
    std::vector<Finding> findings;
    find_odd_gravity(scene, findings);
    find_late_motions(scene, findings);
    find_wide_contact(scene, model, edge_length, findings);
    find_short_run(scene, findings);
    find_empty_lists(scene, findings);
    examine_fabrics(scene, model, findings);
    std::vector<InputPlace> places;
    for (std::size_t b = 0; b < model.bodies.size(); ++b) places.push_back(scene.place(fmt::format("body[{}]", b)));
    append_findings(findings, examine_body_pairs(model.bodies, places));
    return findings;
}

}  // namespace selvage
