// Cusick's drape test: a disc of cloth on a smaller round support, ISO 9073-9, fabrics_cusick.csv.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "host/scene/run_settings.hpp"
#include "host/scene/scene_model.hpp"
#include "host/solver/stepping/equilibrium.hpp"
#include "io/scene/fabric_table.hpp"
#include "io/scene/read_scene.hpp"
#include "validation/cases/cases.hpp"
#include "validation/measure/drape_shape.hpp"
#include "validation/measure/reference.hpp"

namespace selvage {
namespace {

struct Apparatus {
    double specimen = 0.15, support = 0.09;  // radii [m]
};

constexpr double first_fold_height = 0.005;  // amplitude of the folds in begin_folds [m]

struct DrapeResult {
    double coefficient = 0;  // [%]
    int folds = 0;
};

// Returns the fabric of a row of the table. The table gives no shear and stretch stiffness, so those are cotton's.
Fabric measured_fabric(const std::string& name, double& coefficient, int& folds)
{
    for (const ReferenceRow& row : reference_table("fabrics_cusick.csv")) {
        if (row.text("fabric").find(name) != 0) continue;
        Fabric fabric = fabric_preset("cotton");
        fabric.name = "measured";
        fabric.areal_density = row.number("W_kg_m2");
        fabric.bending_weft = fabric.bending_warp = row.number("B_Nm");
        fabric.hysteresis_weft = fabric.hysteresis_warp = row.number("2HB_N");
        fabric.thickness = 1e-3 * row.number("T_mm");
        coefficient = row.number("DC_percent");
        folds = int(row.number("nodes"));
        return fabric;
    }
    throw std::runtime_error("fabrics_cusick.csv has no fabric " + name);
}

Scene drape_scene(const Fabric& fabric, const Apparatus& apparatus, int across, MeshFamily family)
{
    // The folds do not touch each other, so contact of the cloth with itself would only cost time.
    const std::vector<std::string> choices = {fmt::format("bending.hysteresis={}", fabric.hysteresis_weft > 0),
                                              "contact.self=false"};
    Scene scene = read_scene("builtin:cusick", choices);
    scene.sheets[0].radius = apparatus.specimen;
    scene.sheets[0].resolution = across;
    scene.sheets[0].mesh_family = family;
    scene.sheets[0].fabric = fabric.name;
    scene.bodies[0].radius = apparatus.support;
    scene.fabrics = {{fabric.name, fabric}};
    return scene;
}

std::vector<Vec3> drape_to_rest(const Scene& scene, const SceneModel& model, int load_steps)
{
    const PhaseOptions options = phase_options(scene, model, false);
    BodyQuery query(model.cloth_model.bodies, cloth_reach(model.cloth_model.cloth));
    Profile profile;
    Phase phase(model.cloth_model, options, &query, profile, model.cloth_model.cloth.positions, {});
    EquilibriumOptions until;
    until.step.longest = scene.solver.step;
    until.tolerance = scene.solver.tolerance;
    until.max_time = scene.solver.max_time;
    until.newton_iterations = scene.solver.newton_iterations;
    until.load_steps = load_steps;
    DrapeProgress progress;
    if (drape_to_equilibrium(phase, until, progress, [](const StepEvent&) { return true; }) != PhaseEnd::reached)
        throw std::runtime_error(fmt::format("the disc did not come to rest, residual {:.2e}", progress.residual));
    return phase.positions();
}

// Adds a small ripple with this number of folds to the overhang. It selects one of several stable drapes, which would
// otherwise depend on the mesh.
void begin_folds(int folds, const Apparatus& apparatus, Cloth& cloth)
{
    for (std::size_t v = 0; v < cloth.positions.size(); ++v) {
        const Vec2& x = cloth.panel_coordinates[v];
        const double out = std::max(0.0, (x.norm() - apparatus.support) / (apparatus.specimen - apparatus.support));
        cloth.positions[v].z() += first_fold_height * out * out * std::cos(folds * std::atan2(x.y(), x.x()));
    }
}

DrapeResult drape(const Fabric& fabric, const Apparatus& apparatus, int across, MeshFamily family = MeshFamily::panel,
                  int load_steps = 6, int folds = 0)
{
    const Scene scene = drape_scene(fabric, apparatus, across, family);
    SceneModel model = build_scene_model(scene);
    if (folds > 0) begin_folds(folds, apparatus, model.cloth_model.cloth);
    const DrapeShadow shadow = drape_shadow(drape_to_rest(scene, model, load_steps), model.cloth_model.cloth.faces);
    const double support = std::numbers::pi * apparatus.support * apparatus.support;
    const double specimen = std::numbers::pi * apparatus.specimen * apparatus.specimen;
    return {100 * (shadow.area - support) / (specimen - support), shadow.folds};
}

// Returns the number of vertices across a disc of 30 cm whose edges have this length [m].
int across(double edge_length) { return int(std::lround(0.3 / edge_length)) + 1; }

double difference(const std::vector<double>& values)
{
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return *most - *least;
}

// A disc has several equilibria, with different numbers of folds and drape coefficients, and tiny disturbances decide
// which one it reaches. Meshes are therefore judged by drapes with equal numbers of folds; the differences between the
// other drapes are reported without a verdict.
void compare_meshes(CaseReport& report, const Fabric& cotton, const std::string& kind, int folds)
{
    report.from(
        "the same drape on other meshes; judged among equal numbers of folds, each being an equilibrium of its own");
    std::vector<double> all;
    std::map<int, std::vector<double>> with_folds;
    const auto add = [&](const std::string& name, double edge_length, MeshFamily family) {
        const DrapeResult result = drape(cotton, {}, across(edge_length), family, 6, folds);
        all.push_back(result.coefficient);
        with_folds[result.folds].push_back(result.coefficient);
        report.inform(fmt::format("cotton broad A, {}, {}: drape coefficient [%]", kind, name), all.front(),
                      result.coefficient);
        report.inform(fmt::format("cotton broad A, {}, {}: folds", kind, name), folds > 0 ? folds : result.folds,
                      result.folds);
    };
    add("panel mesh, 4 mm", 4e-3, MeshFamily::panel);
    add("panel mesh, 6 mm", 6e-3, MeshFamily::panel);
    add("panel mesh, 3 mm", 3e-3, MeshFamily::panel);
    for (const MeshFamily family : {MeshFamily::equilateral, MeshFamily::square, MeshFamily::irregular})
        add(fmt::format("{}, 4 mm", word_of(family)), 4e-3, family);
    for (const auto& [count, alike] : with_folds)
        if (alike.size() > 1)
            report.absolute(fmt::format("cotton broad A, {}, {} meshes with {} folds: largest difference [points]",
                                        kind, alike.size(), count),
                            0, difference(alike), 2);
    if (with_folds.size() > 1)
        report.inform(
            fmt::format("cotton broad A, {}, all meshes, folds mixed: largest difference, 2 if alike [points]", kind),
            2, difference(all));
    if (folds > 0)
        report.absolute(fmt::format("cotton broad A, {}: meshes that keep them", kind), double(all.size()),
                        double(with_folds[folds].size()), 0);
}

}  // namespace

void check_cusick(CaseReport& report)
{
    for (const char* name : {"cotton broad", "polyester tropical"}) {
        double coefficient = 0;
        int folds = 0;
        const Fabric fabric = measured_fabric(name, coefficient, folds);
        const double edge_length = report.quick() ? 6e-3 : 4e-3;
        report.from("fabrics_cusick.csv: Matsudaira et al. 2015, second hand");
        const DrapeResult iso = drape(fabric, {}, across(edge_length));
        report.absolute(fmt::format("{}, 30 cm on 18 cm, {:g} mm: drape coefficient [%]", name, 1e3 * edge_length),
                        coefficient, iso.coefficient, 7);
        report.inform(fmt::format("{}, 30 cm on 18 cm: folds", name), folds, iso.folds);
        const DrapeResult dropped = drape(fabric, {}, across(6e-3), MeshFamily::panel, 1);
        report.inform(fmt::format("{}, dropped, 6 mm: drape coefficient [%]", name), coefficient, dropped.coefficient);
        report.inform(fmt::format("{}, dropped, 6 mm: folds", name), folds, dropped.folds);
        if (report.quick()) continue;
        const DrapeResult other = drape(fabric, {0.127, 0.0635}, int(std::lround(0.254 / edge_length)) + 1);
        report.inform(fmt::format("{}, 25.4 cm on 12.7 cm: drape coefficient [%]", name), coefficient,
                      other.coefficient);
        report.inform(fmt::format("{}, 25.4 cm on 12.7 cm: folds", name), folds, other.folds);
    }
    if (report.quick()) return;
    double coefficient = 0;
    int folds = 0;
    Fabric cotton = measured_fabric("cotton broad", coefficient, folds);
    cotton.hysteresis_weft = cotton.hysteresis_warp = 0;  // with hysteresis a drape would depend on its history
    compare_meshes(report, cotton, "elastic, left alone", 0);
    compare_meshes(report, cotton, "elastic, begun with five folds", 5);
}

void check_doubling(CaseReport& report)
{
    report.from("the finer mesh before it");
    double coefficient = 0;
    int folds = 0;
    Fabric cotton = measured_fabric("cotton broad", coefficient, folds);
    cotton.hysteresis_weft = cotton.hysteresis_warp = 0;
    std::vector<double> all;
    for (const int vertices : {16, 32, 64, 128, 256}) {
        if (report.quick() && vertices > 64) break;
        const DrapeResult result = drape(cotton, {}, vertices, MeshFamily::panel, 6, 5);
        all.push_back(result.coefficient);
        report.inform(fmt::format("cotton broad A, {} vertices across: folds", vertices), 5, result.folds);
        report.inform(fmt::format("cotton broad A, {} vertices across: drape coefficient [%]", vertices),
                      all.size() > 1 ? all[all.size() - 2] : all.back(), all.back());
    }
    for (std::size_t i = 2; i < all.size(); ++i) {
        const double before = std::abs(all[i - 1] - all[i - 2]), now = std::abs(all[i] - all[i - 1]);
        report.judge(fmt::format("change at {} vertices across, below the one before [points]", 16 << i), before, now,
                     now, before);
    }
}

}  // namespace selvage
