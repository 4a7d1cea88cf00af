#include "io/scene/scene_checks.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string_view>

#include "io/number_text.hpp"
#include "io/scene/fabric_table.hpp"
#include "io/scene/pin_checks.hpp"
#include "io/scene/presets.hpp"

namespace selvage {
namespace {

void check_file(const Scene& scene, const std::string& key, const std::string& name, std::string_view kind)
{
    InputPlace place = scene.place(key);
    if (name.empty()) {
        // The key may be absent; its table shows where it belongs.
        if (place.line == 0) place = scene.place(key.substr(0, key.rfind('.')));
        place.key = key;
        throw InputError(place, "no file name", kind);
    }
    const std::string path = scene.resolve(name);
    std::error_code error;  // a name may be longer than a file system knows
    if (!std::filesystem::is_regular_file(path, error)) {
        const bool exists = std::filesystem::exists(path, error);
        throw InputError(place, "`" + name + "`, " + (exists ? "not a file: " : "no such file: ") + path, kind);
    }
}

void check_garment(const Scene& scene)
{
    const bool given = scene.places.count("garment") > 0;
    if (!given && scene.sheets.empty())
        throw InputError({scene.file, 0, 0, {}}, "neither [garment] nor [[sheet]]", "a scene with cloth in it");
    if (!given) return;
    constexpr std::string_view kind = "a GarmentCode JSON file or a built-in pattern such as builtin:tshirt";
    const std::string& pattern = scene.garment.pattern;
    if (!is_builtin(pattern)) check_file(scene, "garment.pattern", pattern, kind);
}

void check_sheet(const Scene& scene, int index, std::set<std::string>& names)
{
    const SheetScene& sheet = scene.sheets[std::size_t(index)];
    const std::string path = "sheet[" + std::to_string(index) + "].";
    if (sheet.shape == SheetShape::mesh) check_file(scene, path + "mesh", sheet.mesh, "an OBJ file, as shape is mesh");
    if (!sheet.name.empty() && !names.insert(sheet.name).second)
        throw InputError(scene.place(path + "name"), "`" + sheet.name + "` a second time",
                         "a name of its own per sheet");
}

// What moves a body must fit its shape, and keyframes follow each other in time.
void check_motion(const Scene& scene, int index)
{
    const BodyScene& body = scene.bodies[std::size_t(index)];
    const std::string path = "body[" + std::to_string(index) + "].";
    if (!body.sequence.empty() && body.shape != BodyShape::mesh)
        throw InputError(scene.place(path + "sequence"), "`" + body.sequence + "` for a " + text_of(body.shape),
                         "no sequence, or shape = \"mesh\"");
    double last = 0;
    for (std::size_t k = 0; k < body.keyframes.size(); ++k) {
        const KeyframeScene& key = body.keyframes[k];
        const std::string at = path + "keyframe[" + std::to_string(k) + "].";
        if (!(key.time > last))
            throw InputError(scene.place(at + "time"), number_text(key.time) + " s",
                             "a time above " + number_text(last) + " s, that of the keyframe before");
        last = key.time;
        if (!std::isnan(key.arm_angle) && body.shape != BodyShape::mannequin)
            throw InputError(scene.place(at + "arm_angle"), "an arm angle for a " + text_of(body.shape),
                             "none, or shape = \"mannequin\"");
        if (key.mesh.empty()) continue;
        if (body.shape != BodyShape::mesh || !body.sequence.empty())
            throw InputError(scene.place(at + "mesh"), "`" + key.mesh + "`",
                             "none, or shape = \"mesh\" without a sequence");
        check_file(scene, at + "mesh", key.mesh, "an OBJ file of the pose");
    }
}

// What moves feeds energy in, which cannot be told from what an unstable step does; and a rest at part of the weight
// is none while something moves.
void check_solver_of_motion(const Scene& scene)
{
    if (!scene.moves()) return;
    const IntegratorChoice integrator = scene.solver.integrator;
    if (integrator != IntegratorChoice::automatic && integrator != IntegratorChoice::implicit_euler &&
        integrator != IntegratorChoice::bdf2)
        throw InputError(scene.place("solver.integrator"), "`" + text_of(integrator) + "`",
                         "automatic, implicit_euler or bdf2, as a body or pin moves");
    if (scene.solver.load_steps > 1)
        throw InputError(scene.place("solver.load_steps"), std::to_string(scene.solver.load_steps),
                         "1, as a body or pin moves");
}

// A key that the response in use has no place for is a mistake, and so is what a rule on velocities cannot do.
void check_response(const Scene& scene)
{
    const ContactScene& contact = scene.contact;
    const bool rule = contact.response == ContactResponse::velocity_rule;
    if (!rule && !std::isnan(contact.restitution))
        throw InputError(
            scene.place("contact.restitution"), number_text(contact.restitution),
            "none, as contact.response is " + text_of(contact.response) + " and only velocity_rule bounces");
    if (!rule) return;
    if (!std::isnan(contact.stiffness))
        throw InputError(scene.place("contact.stiffness"), number_text(contact.stiffness) + " Pa",
                         "none, as contact.response is velocity_rule and presses with no force");
    if (contact.self && scene.places.count("contact.self"))
        throw InputError(scene.place("contact.self"), "true",
                         "false or none, as contact.response is velocity_rule and knows of bodies only");
    if (scene.bodies.empty() || !contact.body) return;
    if (scene.until().equilibrium)
        throw InputError(scene.place("solver.until"), "\"equilibrium\"",
                         "simulated seconds, as contact.response is velocity_rule and no force balances the weight");
    for (std::size_t body = 0; body < scene.bodies.size(); ++body)
        if (scene.bodies[body].moves())
            throw InputError(scene.place("body[" + std::to_string(body) + "]"), "a body that moves",
                             "one that stands still, as contact.response is velocity_rule");
}

void check_body(const Scene& scene, int index, std::set<std::string>& names)
{
    const BodyScene& body = scene.bodies[std::size_t(index)];
    const std::string path = "body[" + std::to_string(index) + "].";
    if (body.shape == BodyShape::mesh && (body.sequence.empty() || !body.mesh.empty()))
        check_file(scene, path + "mesh", body.mesh, "an OBJ file, as shape is mesh");
    check_motion(scene, index);
    if (body.shape == BodyShape::torus && !(body.tube < body.radius))
        throw InputError(scene.place(path + "tube"), number_text(body.tube) + " m",
                         "less than the radius of " + number_text(body.radius) + " m");
    if (body.shape == BodyShape::torus && body.normal.norm() == 0)
        throw InputError(scene.place(path + "normal"), "[0, 0, 0]", "a direction");
    if (body.shape == BodyShape::plane && body.normal.norm() == 0)
        throw InputError(scene.place(path + "normal"), "[0, 0, 0]", "a direction");
    if (body.shape == BodyShape::capsule && body.center == body.end)
        throw InputError(scene.place(path + "end"), "the same point as `center`", "the capsule's other end [m]");
    if (!body.name.empty() && !names.insert(body.name).second)
        throw InputError(scene.place(path + "name"), "`" + body.name + "` a second time", "a name of its own per body");
}

void check_until(const Scene& scene)
{
    if (!scene.until().equilibrium && scene.solver.integrator == IntegratorChoice::quasistatic)
        throw InputError(scene.place("solver.until"), "`" + scene.solver.until + "`",
                         "\"equilibrium\", as solver.integrator is static and knows no time");
}

void resolve_fabric(Scene& scene, const std::string& name, const std::string& key)
{
    if (scene.fabrics.count(name)) return;
    std::vector<std::string> names = fabric_preset_names();
    if (std::find(names.begin(), names.end(), name) != names.end()) {
        scene.fabrics[name] = fabric_preset(name);
        return;
    }
    for (const auto& [defined, fabric] : scene.fabrics) names.push_back(defined);
    throw InputError(scene.place(key), "`" + name + "`", "a built-in fabric or a table [fabric." + name + "]",
                     nearest_name(name, names));
}

}  // namespace

void check_scene(const Scene& scene)
{
    check_garment(scene);
    std::set<std::string> sheets, names;
    for (int sheet = 0; sheet < int(scene.sheets.size()); ++sheet) check_sheet(scene, sheet, sheets);
    for (int body = 0; body < int(scene.bodies.size()); ++body) check_body(scene, body, names);
    check_until(scene);
    check_elastics(scene);
    check_pins(scene);
    check_solver_of_motion(scene);
    check_response(scene);
}

void resolve_fabrics(Scene& scene)
{
    if (scene.has_garment()) resolve_fabric(scene, scene.garment.fabric, "garment.fabric");
    for (const auto& [panel, fabric] : scene.panel_fabrics) resolve_fabric(scene, fabric, "garment.fabrics." + panel);
    for (int sheet = 0; sheet < int(scene.sheets.size()); ++sheet)
        resolve_fabric(scene, scene.sheets[std::size_t(sheet)].fabric, "sheet[" + std::to_string(sheet) + "].fabric");
}

}  // namespace selvage
