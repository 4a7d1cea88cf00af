#include "io/scene/key_rules.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "io/integrators.hpp"
#include "io/scene/presets.hpp"

namespace selvage {
namespace {

// One element of a scene that keys belong to: a table, or one of a repeated table.
struct Element {
    const Scene& scene;
    std::size_t index = 0;
    std::string name = {};  // of a fabric

    const SheetScene& sheet() const { return scene.sheets[index]; }
    const BodyScene& body() const { return scene.bodies[index]; }
    const PinMotionScene& motion() const { return scene.pin_motions[index]; }
};

struct KeyRule {
    const char* table;
    const char* keys;  // separated by blanks; *: all
    bool (*count)(const Element&);
    const char* need;      // what they need, for the message
    const char* deciding;  // keys that decide, separated by blanks; those that begin with a point are of the same table
};

bool sheet_is(const Element& e, SheetShape shape) { return e.sheet().shape == shape; }

template <class... Shapes>
bool body_is(const Element& e, Shapes... shapes)
{
    return ((e.body().shape == shapes) || ...);
}

bool to_rest(const Element& e) { return e.scene.until().equilibrium; }

// May have seams: a mesh has some where its texture is cut.
bool sews(const Element& e)
{
    const auto is_mesh = [](const SheetScene& sheet) { return sheet.shape == SheetShape::mesh; };
    return e.scene.has_garment() || std::ranges::any_of(e.scene.sheets, is_mesh);
}

bool builtin_pattern(const Element& e) { return is_builtin(e.scene.garment.pattern); }

bool meets_bodies(const Element& e) { return e.scene.contact.body && !e.scene.bodies.empty(); }

bool meets_anything(const Element& e) { return e.scene.contact.self || meets_bodies(e); }

struct Scheme {
    IntegratorChoice choice;
    bool is_explicit;
    int error_power;
};

Scheme scheme(const Element& e)
{
#define SCHEME(name, word, order, is_explicit, error_power, summary) {IntegratorChoice::name, is_explicit, error_power},
    static constexpr Scheme schemes[] = {INTEGRATORS(SCHEME)};
#undef SCHEME
    const auto* found = std::ranges::find(schemes, e.scene.solver.integrator, &Scheme::choice);
    return found == std::end(schemes) ? schemes[0] : *found;  // automatic: implicit and with an estimate
}

bool has_limit(const Element& e)
{
    const Fabric& fabric = e.scene.fabrics.at(e.name);
    return fabric.stretch_limit > 0 || fabric.shear_limit > 0;
}

constexpr const char* needs_garment = "a scene with seams: [garment], or a sheet of shape \"mesh\"";

// Where each key counts that does not count everywhere. A flag that is off is obeyed everywhere. Keys of which the plan
// tells why they have no effect (scales of a model that is off) are not here, nor are properties of fabrics that a
// scene happens not to need.
using enum BodyShape;
constexpr KeyRule rules[] = {
    {"sheet", "width height", [](const Element& e) { return sheet_is(e, SheetShape::rectangle); },
     "shape = \"rectangle\"", ".shape"},
    {"sheet", "radius", [](const Element& e) { return sheet_is(e, SheetShape::disc); }, "shape = \"disc\"", ".shape"},
    {"sheet", "resolution mesh_family", [](const Element& e) { return !sheet_is(e, SheetShape::mesh); },
     "a shape that is meshed here: \"rectangle\" or \"disc\"", ".shape"},
    {"sheet", "mesh unit texture_unit up_axis weld", [](const Element& e) { return sheet_is(e, SheetShape::mesh); },
     "shape = \"mesh\"", ".shape"},

    {"body", "mesh unit up_axis scale weld close_holes", [](const Element& e) { return body_is(e, mesh); },
     "shape = \"mesh\"", ".shape"},
    {"body", "rotation", [](const Element& e) { return body_is(e, mesh, mannequin); },
     "shape = \"mesh\" or \"mannequin\"", ".shape"},
    {"body", "end", [](const Element& e) { return body_is(e, capsule); }, "shape = \"capsule\"", ".shape"},
    {"body", "normal", [](const Element& e) { return body_is(e, plane, torus); }, "shape = \"plane\" or \"torus\"",
     ".shape"},
    {"body", "radius", [](const Element& e) { return body_is(e, sphere, capsule, cylinder, cone, torus); },
     "shape = \"sphere\", \"capsule\", \"cylinder\", \"cone\" or \"torus\"", ".shape"},
    {"body", "height", [](const Element& e) { return body_is(e, cylinder, cone); }, "shape = \"cylinder\" or \"cone\"",
     ".shape"},
    {"body", "tube", [](const Element& e) { return body_is(e, torus); }, "shape = \"torus\"", ".shape"},
    {"body", "size figure stature bust waist hips shoulder_width neck arm_length arm_angle",
     [](const Element& e) { return body_is(e, mannequin); }, "shape = \"mannequin\"", ".shape"},
    {"body", "friction", meets_bodies, "contact.body = true", "contact.body"},
    {"body", "interpolation", [](const Element& e) { return !e.body().keyframes.empty(); },
     "[[body.keyframe]] to interpolate between", ""},
    {"body", "sequence_rate sequence_start", [](const Element& e) { return !e.body().sequence.empty(); }, "`sequence`",
     ".sequence"},

    {"garment", "size", builtin_pattern, "a built-in pattern", "garment.pattern"},
    {"garment", "up_axis rotation_order", [](const Element& e) { return !builtin_pattern(e); },
     "a pattern file, not a built-in pattern", "garment.pattern"},
    {"garment", "arrange", [](const Element& e) { return !builtin_pattern(e); },
     "a pattern file: built-in patterns are drafted in their places", "garment.pattern"},
    {"garment", "copy_offset", [](const Element& e) { return e.scene.garment.copies > 1; }, "copies above 1",
     "garment.copies"},

    {"pins.motion", "axis point", [](const Element& e) { return e.motion().turns != 0; }, "`turns`", ""},

    {"solver", "tolerance load_steps max_time", to_rest, "solver.until = \"equilibrium\"", "solver.until"},
    {"solver", "step_tolerance", [](const Element& e) { return !scheme(e).is_explicit && !to_rest(e); },
     "an implicit solver.integrator and solver.until = SECONDS", "solver.integrator solver.until"},
    {"solver", "progressive", [](const Element& e) { return !e.scene.solver.progressive || to_rest(e); },
     "solver.until = \"equilibrium\"", "solver.until"},
    {"solver", "sleep", [](const Element& e) { return !e.scene.solver.sleep || to_rest(e); },
     "solver.until = \"equilibrium\"", "solver.until"},
    {"solver", "unstable_step", [](const Element& e) { return scheme(e).is_explicit; },
     "an explicit solver.integrator, from symplectic_euler to rk4", "solver.integrator"},
    {"solver", "adaptive", [](const Element& e) { return !e.scene.solver.adaptive || scheme(e).error_power > 0; },
     "a solver.integrator that estimates its error", "solver.integrator"},
    {"solver", "step_error", [](const Element& e) { return e.scene.solver.adaptive; }, "solver.adaptive = true",
     "solver.adaptive"},
    {"solver", "newton_iterations linear_iterations",
     [](const Element& e) { return !scheme(e).is_explicit || to_rest(e) || sews(e); },
     "an implicit solver.integrator, or equations to solve on the way to rest", "solver.integrator solver.until"},
    {"solver", "energy_tolerance", sews, needs_garment, ""},

    {"contact", "body", [](const Element& e) { return !e.scene.contact.body || !e.scene.bodies.empty(); }, "[[body]]",
     ""},
    {"contact", "response gap stiffness", meets_anything, "contact.self = true, or bodies and contact.body = true",
     "contact.self contact.body"},

    {"seams", "*", sews, needs_garment, ""},
    {"output", "sewing", [](const Element& e) { return !e.scene.output.sewing || sews(e); }, needs_garment, ""},
    {"output", "picture_width picture_samples", [](const Element& e) { return e.scene.output.picture; },
     "output.picture = true", "output.picture"},

    {"wind", "density normal_coefficient tangential_coefficient", [](const Element& e) { return e.scene.has_air(); },
     "wind.velocity, wind.gust or wind.still_air = true", "wind.velocity wind.gust wind.still_air"},
    {"wind", "still_air", [](const Element& e) { return !e.scene.wind.still_air || !e.scene.wind_blows(); },
     "air that does not blow: moving air resists motion anyhow", "wind.velocity wind.gust"},
    {"wind", "gust", [](const Element& e) { return e.scene.wind.gust == 0 || !to_rest(e); },
     "solver.until = SECONDS: nothing comes to rest in gusts", "solver.until"},
    {"wind", "gust_time seed", [](const Element& e) { return e.scene.wind.gust > 0 && !to_rest(e); },
     "wind.gust above 0, and solver.until = SECONDS", "wind.gust solver.until"},

    {"fabric", "hysteresis_weft hysteresis_warp", [](const Element& e) { return e.scene.bending.hysteresis; },
     "bending.hysteresis = true", "bending.hysteresis"},
    {"fabric", "stretch_limit_factor", has_limit, "`stretch_limit` or `shear_limit`", ""},
};

std::vector<std::string> words(const char* list)
{
    std::istringstream stream(list);
    std::vector<std::string> all;
    for (std::string word; stream >> word;) all.push_back(word);
    return all;
}

bool from_command_line(const Scene& scene, const std::string& key)
{
    const auto found = scene.places.find(key);
    return found != scene.places.end() && found->second.file.starts_with("--set ");
}

// The keys of a table that a scene gives.
std::vector<std::string> given_keys(const Scene& scene, const std::string& table, const char* keys)
{
    std::vector<std::string> given;
    if (std::string_view(keys) != "*") {
        for (const std::string& key : words(keys))
            if (scene.places.count(table + "." + key)) given.push_back(table + "." + key);
        return given;
    }
    const std::string inside = table + ".";
    for (auto place = scene.places.lower_bound(inside); place != scene.places.end(); ++place) {
        if (!place->first.starts_with(inside)) break;
        given.push_back(place->first);
    }
    return given;
}

void apply(const KeyRule& rule, const std::string& table, const Element& element, std::vector<std::string>& overruled)
{
    if (rule.count(element)) return;
    const Scene& scene = element.scene;
    const std::vector<std::string> deciding = words(rule.deciding);
    const bool decided = std::ranges::any_of(deciding, [&](const std::string& key) {
        return from_command_line(scene, key.front() == '.' ? table + key : key);
    });
    for (const std::string& key : given_keys(scene, table, rule.keys)) {
        if (!decided || from_command_line(scene, key))
            throw InputError(scene.place(key), "a key that does nothing here", std::string("none, or ") + rule.need);
        overruled.push_back(key);
    }
}

void apply_to_all(const KeyRule& rule, const Scene& scene, std::vector<std::string>& overruled)
{
    const std::string_view table = rule.table;
    const auto repeated = [&](std::size_t count) {
        for (std::size_t k = 0; k < count; ++k)
            apply(rule, std::string(table) + "[" + std::to_string(k) + "]", {scene, k}, overruled);
    };
    if (table == "sheet") return repeated(scene.sheets.size());
    if (table == "body") return repeated(scene.bodies.size());
    if (table == "pins.motion") return repeated(scene.pin_motions.size());
    if (table != "fabric") return apply(rule, std::string(table), {scene}, overruled);
    for (const auto& [name, fabric] : scene.fabrics) apply(rule, "fabric." + name, {scene, 0, name}, overruled);
}

// A table of a fabric that no cloth is made of is a slip of the pen, as [fabric.coton] is.
void check_fabrics_in_use(const Scene& scene, std::vector<std::string>& overruled)
{
    std::vector<std::string> used;
    bool decided = false;
    const auto use = [&](const std::string& key, const std::string& fabric) {
        used.push_back(fabric);
        decided = decided || from_command_line(scene, key);
    };
    if (scene.has_garment()) use("garment.fabric", scene.garment.fabric);
    for (const auto& [panel, fabric] : scene.panel_fabrics) use("garment.fabrics." + panel, fabric);
    for (std::size_t k = 0; k < scene.sheets.size(); ++k)
        use("sheet[" + std::to_string(k) + "].fabric", scene.sheets[k].fabric);
    for (const auto& [name, fabric] : scene.fabrics) {
        const std::string table = "fabric." + name;
        if (std::ranges::find(used, name) != used.end() || !scene.places.count(table)) continue;
        if (!decided)
            throw InputError(scene.place(table), "a fabric that no cloth is made of",
                             "the name of one in use, or `fabric = \"" + name + "\"` at a [[sheet]] or in [garment]",
                             nearest_name(name, used));
        overruled.push_back(table);
    }
}

}  // namespace

std::vector<std::string> overruled_keys(const Scene& scene)
{
    std::vector<std::string> overruled;
    for (const KeyRule& rule : rules) apply_to_all(rule, scene, overruled);
    check_fabrics_in_use(scene, overruled);
    return overruled;
}

}  // namespace selvage
