#include "host/scene/scene_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "host/collision/parted_body.hpp"
#include "host/collision/thin_body.hpp"
#include "host/examine/cloth_start.hpp"
#include "host/examine/pattern.hpp"
#include "host/examine/scene.hpp"
#include "host/examine/sheet_mesh.hpp"
#include "host/garment/assemble.hpp"
#include "host/garment/sheet.hpp"
#include "host/mannequin/mannequin.hpp"
#include "host/model/cloth_model.hpp"
#include "host/model/cloth_place.hpp"
#include "host/model/prolongation.hpp"
#include "host/parallel/trace.hpp"
#include "host/scene/body_model.hpp"
#include "host/scene/pin_meetings.hpp"
#include "host/scene/scene_pins.hpp"
#include "host/solver/contact/contact_tuning.hpp"
#include "host/styles/arrange.hpp"
#include "host/styles/styles.hpp"
#include "io/memory.hpp"
#include "io/pattern/pattern_json.hpp"
#include "io/scene/presets.hpp"

namespace selvage {
namespace {

constexpr int coarsest_vertices = 300;  // factorising this costs less than a fine matrix product

// A scene whose mesh alone could not be held is refused before it is made; the plan then counts exactly.
constexpr double bytes_per_vertex = 3000;

constexpr double sliver = 0.1;  // of a typical edge: triangles less high are told of

// A level sheet has nothing that tells it which way to fold: it starts off its plane by up to this part of its extent,
// in a smooth pattern that does not depend on the mesh, so that finer meshes fold alike.
constexpr double ripple = 1e-4;
constexpr int ripple_waves = 7;

struct LeastHeight {
    double height = std::numeric_limits<double>::infinity();  // [m]
    int face = 0;
};

LeastHeight narrowest(const Cloth& cloth)
{
    LeastHeight least;
    for (int face = 0; face < int(cloth.faces.size()); ++face)
        if (const double height = least_height(cloth, face); height < least.height) least = {height, face};
    return least;
}

// Where cloth begins to press on cloth at most [m]; see ContactGaps.
double widest_gap(const Scene& scene, const SceneModel& model)
{
    double thickest = scene.contact.gap;
    for (const auto& [name, fabric] : model.cloth_model.fabrics) thickest = std::max(thickest, fabric.thickness);
    return std::min(thickest, ContactTuning::gap_of_edge * model.edge_length);
}

// What a run cannot do as it is meant.
void find_limits(const Scene& scene, SceneModel& model)
{
    const Cloth& cloth = model.cloth_model.cloth;
    const LeastHeight least = narrowest(cloth);
    if (scene.contact.self && least.height < sliver * model.edge_length)
        model.findings.push_back(
            {"triangle",
             {},
             fmt::format("the narrowest triangle, {}, is {:.2g} m high, where edges are {:.2g} m long: cloth beside it "
                         "presses on cloth of the same piece from less than that height only",
                         describe_face(cloth, least.face, cloth.positions), least.height, model.edge_length),
             "mesh that place without slivers, or its folds come nearer to each other there than contact.gap asks"});
    if (cloth.pinned.size() == cloth.positions.size())
        model.findings.push_back(
            {"pins", scene.place("pins"),
             fmt::format("all {} vertices are held: no cloth is free to move", cloth.positions.size()),
             "leave some vertices free"});
}

bool is_person(const BodyScene& body) { return body.shape == BodyShape::mannequin || body.shape == BodyShape::mesh; }

// Returns the body for which a built-in pattern is drafted: a mannequin of garment.size where that is given, of the
// figure of the scene's own; otherwise the first body of the scene that may be a person; otherwise a mannequin of the
// default size.
StyleBody body_to_dress(const Scene& scene, const std::vector<Body>& bodies)
{
    const auto first = std::ranges::find_if(scene.bodies, is_person);
    const bool person = first != scene.bodies.end();
    const auto index = first - scene.bodies.begin();
    if (person && !scene.places.contains("garment.size"))
        return style_body(bodies[std::size_t(index)].mesh, scene.place(fmt::format("body[{}]", index)));
    const InputPlace place = scene.place("garment.size");
    const BodyFigure figure = person ? first->figure : BodyFigure::automatic;
    return style_body(make_mannequin(mannequin_size(scene.garment.size, figure, place)), place);
}

// Places the panels of a pattern file where it does not, or where the scene asks for it.
void arrange_panels(const Scene& scene, const std::vector<Body>& bodies, Pattern& pattern)
{
    const ArrangementChoice choice = scene.garment.arrange;
    const bool asked = choice == ArrangementChoice::always || !scene.panel_parts.empty();
    if (choice == ArrangementChoice::never && !scene.panel_parts.empty())
        throw InputError(scene.place("garment.arrange"), "`never` beside [garment.parts]", "one of the two");
    const bool dresses = std::ranges::any_of(scene.bodies, is_person);
    if (asked && !dresses)
        throw InputError(scene.place("garment.arrange"), "no person among the bodies",
                         "a [[body]] of shape \"mesh\" or \"mannequin\" on which panels can be placed");
    if (!asked && (choice == ArrangementChoice::never || !dresses || !is_unplaced(pattern))) return;
    std::optional<StyleBody> person;
    try {
        person = body_to_dress(scene, bodies);
    } catch (const InputError& error) {
        if (asked) throw;
        pattern.findings.push_back({"no_place",
                                    {},
                                    fmt::format("the {} panels all have the same place, and they stay there, since the "
                                                "body is no person on whom they could be placed ({})",
                                                pattern.panels.size(), error.what()),
                                    "give the panels a translation, if their outlines do not say where they are"});
        return;
    }
    arrange(pattern, *person, scene.panel_parts);
    pattern.findings.push_back(
        {"arranged",
         {},
         fmt::format("the {} panels are placed on the body by their names and seams", pattern.panels.size()),
         {},
         Severity::note});
}

Pattern read_pattern(const Scene& scene, const std::vector<Body>& bodies)
{
    const std::string& name = scene.garment.pattern;
    Pattern pattern = is_builtin(name)
                          ? draft_style(name.substr(builtin_prefix.size()), body_to_dress(scene, bodies))
                          : read_pattern_json(scene.resolve(name), {scene.garment.up_axis, scene.garment.rotation_order,
                                                                    scene.places.contains("garment.rotation_order")});
    if (!is_builtin(name)) arrange_panels(scene, bodies, pattern);
    if (pattern.file.empty()) pattern.file = name;
    for (PatternPanel& panel : pattern.panels) panel.translation += scene.garment.translation;
    return pattern;
}

Cloth sheet_at(const Scene& scene, int index, int resolution)
{
    SheetScene sheet = scene.sheets[index];
    sheet.resolution = resolution;
    const std::string key = "sheet[" + std::to_string(index) + "]";
    if (sheet.shape == SheetShape::mesh) {
        std::vector<Finding> findings;
        const LoadedSheet loaded = load_sheet(scene, index, findings);
        const bool moves = scene.places.count(key + ".center") > 0;
        Cloth cloth =
            sheet_from_mesh(loaded, sheet, moves ? std::optional(sheet.center) : std::nullopt, scene.file, key);
        append_findings(cloth.findings, findings);
        return cloth;
    }
    return make_sheet(sheet, scene.file, key);
}

// Returns how many vertices a scene may have.
double most_vertices(const Scene& scene) { return memory_limit(scene) / bytes_per_vertex; }

// Returns about how many vertices the plain sheets of a scene have together; those of files are limited by the files.
// Throws InputError for the sheet with which they are too many.
double count_sheet_vertices(const Scene& scene)
{
    double all = 0;
    for (int index = 0; index < int(scene.sheets.size()); ++index) {
        const SheetScene& sheet = scene.sheets[index];
        if (sheet.shape == SheetShape::mesh) continue;
        const double rows =
            sheet.shape == SheetShape::rectangle ? sheet.resolution * sheet.height / sheet.width : sheet.resolution;
        const double vertices = sheet.resolution * std::max(rows, 2.0), most = most_vertices(scene);
        all += vertices;
        if (all <= most) continue;
        throw InputError(scene.place("sheet[" + std::to_string(index) + "].resolution"),
                         fmt::format("{}, which means about {:.3g} vertices{}", sheet.resolution, vertices,
                                     index > 0 ? fmt::format(", {:.3g} with the sheets before it", all) : ""),
                         fmt::format("at most {:.3g} vertices (solver.memory_limit)", most));
    }
    return all;
}

// A sum of plane waves, 1 to 4 across the extent, in directions that share no symmetry; in [-1, 1].
double ripple_at(const Vec2& x)
{
    double sum = 0;
    for (int wave = 0; wave < ripple_waves; ++wave) {
        const double angle = 2.399963 * (wave + 1);  // the golden angle
        const double number = 2 * std::numbers::pi * (1 + 0.5 * wave);
        sum += std::cos(number * (x.x() * std::cos(angle) + x.y() * std::sin(angle)) + 1.7 * wave);
    }
    return sum / ripple_waves;
}

// A sheet that starts folded knows which way to go.
bool is_level(const Cloth& cloth, const ClothPanel& panel, const Vec3& normal, double extent)
{
    const auto first = cloth.positions.begin() + panel.first_vertex;
    return std::all_of(first, first + panel.vertex_count,
                       [&](const Vec3& x) { return std::abs((x - *first).dot(normal)) <= ripple * extent; });
}

void add_ripple(Cloth& cloth)
{
    std::vector<char> held(cloth.positions.size());
    for (int v : cloth.pinned) held[v] = 1;
    for (const ClothPanel& panel : cloth.panels) {
        const Face& f = cloth.faces[panel.first_face];
        const Vec3 normal = (cloth.positions[f[1]] - cloth.positions[f[0]])
                                .cross(cloth.positions[f[2]] - cloth.positions[f[0]])
                                .normalized();
        const double extent = 2 * std::sqrt(panel.rest_area / std::numbers::pi);
        if (!is_level(cloth, panel, normal, extent)) continue;
        for (int v = panel.first_vertex; v < panel.first_vertex + panel.vertex_count; ++v)
            if (!held[v])
                cloth.positions[v] += ripple * extent * ripple_at(cloth.panel_coordinates[v] / extent) * normal;
    }
    for (const auto& [a, b] : cloth.seam_pairs) cloth.positions[b] = cloth.positions[a];
}

// The copy of a garment with a number; the first is the garment itself.
Cloth garment_copy(Cloth garment, const GarmentScene& scene, int copy)
{
    if (copy == 0) return garment;
    garment.findings.clear();
    for (Vec3& x : garment.positions) x += copy * scene.copy_offset;
    for (ClothPanel& panel : garment.panels) panel.name += fmt::format("_{}", copy + 1);
    return garment;
}

// The cloth of the scene `level` halvings of its resolution away; empty if it cannot be made coarser.
Cloth cloth_at_level(const Scene& scene, const Pattern& pattern, int level)
{
    Cloth cloth;
    const double factor = std::pow(2.0, level);
    if (scene.has_garment()) {
        const int copies = scene.garment.copies;
        const double most = std::max(0.0, most_vertices(scene) - count_sheet_vertices(scene)) / copies;
        Cloth garment = assemble_garment(pattern, scene.garment.resolution * factor, scene.garment.fabric,
                                         scene.panel_fabrics, most);
        sew_elastics(garment, scene);
        for (int copy = 0; copy < copies; ++copy) append_cloth(cloth, garment_copy(garment, scene.garment, copy));
    }
    for (int i = 0; i < int(scene.sheets.size()); ++i) {
        const SheetScene& sheet = scene.sheets[i];
        if (level > 0 && sheet.shape == SheetShape::mesh) return {};
        const int resolution = int(std::ceil((sheet.resolution - 1) / factor)) + 1;
        append_cloth(cloth, sheet_at(scene, i, std::max(resolution, level > 0 ? 3 : 2)));
    }
    pin_cloth(cloth, scene, level == 0);
    return cloth;
}

void add_coarser_levels(const Scene& scene, const Pattern& pattern, ClothModel& model)
{
    if (scene.solver.preconditioner == PreconditionerChoice::block_jacobi) return;
    const TraceScope scope("coarser_levels");
    for (int level = 1; level < 10; ++level) {
        const Cloth& finer = level == 1 ? model.cloth : model.coarser.back();
        if (int(finer.positions.size()) <= coarsest_vertices) return;
        Cloth coarse = cloth_at_level(scene, pattern, level);
        // Where short outline edges keep the mesh fine, a coarser level is no longer worth its cost.
        if (coarse.positions.empty() || coarse.positions.size() * 10 > finer.positions.size() * 7) return;
        model.prolongations.push_back(make_prolongation(coarse, finer));
        model.coarser.push_back(std::move(coarse));
    }
}

// Lets a garment that is sewn around a body pass between parts of it that touch.
void make_room(const Scene& scene, SceneModel& model)
{
    if (!model.body_between || !scene.contact.body || scene.seams.room == 0) return;
    std::vector<Body>& bodies = model.cloth_model.bodies;
    std::vector<SeamWay> ways;
    const Cloth& cloth = model.cloth_model.cloth;
    for (const auto& pair : cloth.seam_pairs) ways.push_back({cloth.positions[pair[0]], cloth.positions[pair[1]]});
    std::vector<Body> parted = parted_bodies(bodies, scene.seams.room, std::move(ways));
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        double most = 0;
        for (std::size_t v = 0; v < bodies[b].mesh.vertices.size(); ++v)
            most = std::max(most, (parted[b].mesh.vertices[v] - bodies[b].mesh.vertices[v]).norm());
        if (most == 0) continue;
        model.findings.push_back({"parted_body",
                                  {},
                                  fmt::format("parts of the body `{}` touch each other or nearly: to let cloth pass "
                                              "between them they give way by up to {:.1f} mm (seams.room)",
                                              bodies[b].name, 1000 * most),
                                  {},
                                  Severity::note});
    }
    bodies = std::move(parted);
}

}  // namespace

SceneModel build_scene_model(const Scene& scene)
{
    const TraceScope scope("assemble");
    SceneModel result;
    std::vector<Finding> of_bodies;
    result.cloth_model.bodies = build_bodies(scene, of_bodies);
    Pattern pattern;
    if (scene.has_garment()) pattern = read_pattern(scene, result.cloth_model.bodies);
    count_sheet_vertices(scene);
    result.cloth_model.cloth = cloth_at_level(scene, pattern, 0);
    // A fabric that no panel is made of must not decide which terms run.
    for (const ClothPanel& panel : result.cloth_model.cloth.panels)
        result.cloth_model.fabrics[panel.fabric] = scene.fabrics.at(panel.fabric);
    result.findings = pattern.findings;
    append_findings(result.findings, of_bodies);
    add_coarser_levels(scene, pattern, result.cloth_model);
    append_findings(result.findings, result.cloth_model.cloth.findings);
    if (scene.has_garment())
        append_findings(result.findings, examine_pattern(pattern, result.cloth_model.cloth, scene.garment.resolution));
    result.sews = !seams_are_closed(result.cloth_model.cloth);
    result.body_between = result.sews && seams_meet_bodies(result.cloth_model.cloth, result.cloth_model.bodies);
    make_room(scene, result);
    result.edge_length = typical_edge(result.cloth_model.cloth);
    find_limits(scene, result);
    append_findings(result.findings, examine_scene(scene, result.cloth_model, result.edge_length));
    if (std::optional<Finding> meeting = find_meeting_pins(result.cloth_model.cloth, scene, widest_gap(scene, result)))
        result.findings.push_back(std::move(*meeting));
    if (!scene.has_garment()) {
        add_ripple(result.cloth_model.cloth);
        for (Cloth& coarser : result.cloth_model.coarser) add_ripple(coarser);
    }
    append_findings(result.findings, examine_start(result.cloth_model, scene));
    return result;
}

SceneModel coarser_model(const SceneModel& model, std::size_t level)
{
    const ClothModel& whole = model.cloth_model;
    const auto from = std::ptrdiff_t(level) + 1;
    SceneModel result;
    result.cloth_model = {whole.coarser[level],
                          {whole.coarser.begin() + from, whole.coarser.end()},
                          {whole.prolongations.begin() + from, whole.prolongations.end()},
                          whole.fabrics,
                          whole.bodies};
    result.sews = model.sews;
    result.body_between = model.body_between;
    result.edge_length = typical_edge(result.cloth_model.cloth);
    return result;
}

double memory_limit(const Scene& scene)
{
    return scene.solver.memory_limit > 0 ? scene.solver.memory_limit : 0.9 * double(physical_memory_bytes());
}

Box cloth_reach(const Cloth& cloth)
{
    const Box start = box_of(cloth.positions);
    const Vec3 margin = Vec3::Constant(0.25 * start.sizes().norm());
    return {start.min() - margin, start.max() + margin};
}

}  // namespace selvage
