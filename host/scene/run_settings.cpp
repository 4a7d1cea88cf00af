#include "host/scene/run_settings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/model/motion_reach.hpp"
#include "host/scene/coarse_start.hpp"
#include "host/scene/features.hpp"
#include "host/scene/scene_values.hpp"

namespace selvage {
namespace {

// Vertices. The ratio of the stiffest to the softest motion grows with the square of the resolution: where it nears the
// 16 million steps of single precision, directions of descent get lost in rounding.
constexpr std::size_t most_in_float = 500000;

// k h^2 / (rho dx^2): how much stiffer the stretch of an edge is than its inertia. Pendulums of 33 vertices a side took
// as many iterations in float as in double up to 2e6, a third more at 2e7 and four times as many at 2e8.
constexpr double stiffest_in_float = 5e6;

// Vertices up to which solves are direct where there is no coarser mesh. Pendulums of 81 and 289 vertices then take as
// long as with block Jacobi at 1e2 to 1e5 N/m and a third at 1e7, strips of 1e5 N/m a twentieth; with coarser meshes,
// from 625 on, multigrid is twice as fast. A factor grows with the power 1.5 of its size.
constexpr std::size_t most_directly = 1000;

bool is_solved_directly(const Scene& scene, const ClothModel& model)
{
    return scene.solver.preconditioner == PreconditionerChoice::automatic && model.coarser.empty() &&
           model.cloth.positions.size() <= most_directly;
}

double stretch_over_inertia(const Scene& scene, const ClothModel& model)
{
    double stiffest = 0;
    for (const ClothPanel& panel : model.cloth.panels) {
        const Fabric& fabric = model.fabrics.at(panel.fabric);
        const double edge_squared = 4 / std::numbers::sqrt3 * panel.rest_area / std::max(panel.face_count, 1);
        const double stiffness = scene.membrane.scale * std::max(fabric.stretch_weft, fabric.stretch_warp);
        stiffest = std::max(stiffest, stiffness / (fabric.areal_density * edge_squared));
    }
    return scene.solver.step * scene.solver.step * stiffest;
}

// Weight over bending, rho g L^3 / B, from which on cloth hangs in folds rather than bends like a plate; a strip's end
// points down by 45 degrees at about 8. By hand.
constexpr double limp = 100;

bool is_limp(const ClothModel& model)
{
    return std::ranges::any_of(model.cloth.panels, [&model](const ClothPanel& panel) {
        const Fabric& fabric = model.fabrics.at(panel.fabric);
        const double bending = std::min(fabric.bending_weft, fabric.bending_warp);
        return fabric.areal_density * 9.81 * std::pow(panel.rest_area, 1.5) > limp * bending;
    });
}

ClothSettings cloth_settings(const Scene& scene, const SceneModel& model)
{
    ClothSettings settings;
    if (model.sews) settings.sewing = phase_options(scene, model, true);
    settings.draping = phase_options(scene, model, false);
    settings.sew.step = scene.solver.step;
    settings.sew.closed = scene.seams.closed;
    settings.sew.energy_tolerance = scene.solver.energy_tolerance;
    settings.sew.max_time = scene.seams.max_time;
    settings.sew.first_stiffness = settings.sewing.params.seam.stiffness;
    settings.sew.first_limit = settings.sewing.params.seam.force_limit;
    settings.sew.edge_length = model.edge_length;
    settings.sew.thin_at_once = model.body_between;
    settings.sew.thin = why_no_thin_bodies(scene, model).empty() ? scene.seams.thin : 0;
    return settings;
}

EquilibriumOptions drape_options(const SolverScene& solver)
{
    EquilibriumOptions options;
    options.step.longest = solver.step;
    options.step.adaptive = solver.adaptive;
    options.step.error = solver.step_error;
    options.step.unstable = solver.unstable_step;
    options.hurries = solver.integrator != IntegratorChoice::bdf2;  // who asks for it asks for the whole motion
    options.tolerance = solver.tolerance;
    options.max_time = solver.max_time;
    options.newton_iterations = solver.newton_iterations;
    options.sleeps = solver.sleep;
    options.load_steps = solver.load_steps;
    return options;
}

// Whether a motion takes part in how the cloth comes to rest: that of a body which never comes near it does not.
bool moves_near_cloth(const Scene& scene, const ClothModel& model)
{
    const Box reach = swing_reach(box_of(model.cloth.positions), scene.solver.gravity);
    return !scene.pin_motions.empty() || std::any_of(model.bodies.begin(), model.bodies.end(),
                                                     [&](const Body& body) { return moves_within(body, reach); });
}

}  // namespace

RunSettings make_run_settings(const Scene& scene, const SceneModel& model)
{
    RunSettings settings;
    settings.name = scene.name;
    settings.file = scene.file;
    settings.text = scene.text;
    settings.values = scene_values(scene);
    settings.step_place = scene.place("solver.step");
    settings.cloth = cloth_settings(scene, model);
    if (why_no_coarse_start(scene, model).empty())
        for (std::size_t level = 0; level < levels_used(scene, model); ++level)
            settings.coarser.push_back(cloth_settings(scene, coarser_model(model, level)));
    settings.integrator = integrator_of(scene, model.cloth_model);
    settings.precision = solve_precision(scene, model.cloth_model);
    settings.until = scene.until();
    settings.drape = drape_options(scene.solver);
    settings.drape.step_tolerance = step_tolerance(scene, model.cloth_model);
    settings.max_wall = scene.solver.max_wall;
    settings.frame_rate = scene.solver.frame_rate;
    settings.output = scene.output;
    return settings;
}

PhaseOptions phase_options(const Scene& scene, const SceneModel& model, bool sewing)
{
    PhaseOptions options;
    options.params = phase_params(scene, model, sewing);
    options.joined = !sewing;
    options.local_stiffness = std::isnan(scene.contact.stiffness);
    options.float_solves = solve_precision(scene, model.cloth_model) == PrecisionChoice::in_float;
    options.linear.max_iterations = scene.solver.linear_iterations;
    const bool levels =
        !model.cloth_model.coarser.empty() && scene.solver.preconditioner != PreconditionerChoice::block_jacobi;
    // Exact directions pull the sides of a seam straight at each other: a tight skirt's were caught on its body.
    const bool direct = !sewing && is_solved_directly(scene, model.cloth_model);
    options.linear.preconditioner = direct   ? Preconditioner::direct
                                    : levels ? Preconditioner::multigrid
                                             : Preconditioner::block_jacobi;
    if (scene.has_air()) {
        const WindScene& wind = scene.wind;
        options.air.emplace(wind.velocity, wind.gust, wind.gust_time, std::uint32_t(wind.seed));
    }
    return options;
}

PrecisionChoice solve_precision(const Scene& scene, const ClothModel& model)
{
    if (scene.solver.precision != PrecisionChoice::automatic) return scene.solver.precision;
    // A factor is double anyhow.
    const bool is_hard = is_solved_directly(scene, model) || model.cloth.positions.size() > most_in_float ||
                         stretch_over_inertia(scene, model) > stiffest_in_float;
    return is_hard ? PrecisionChoice::in_double : PrecisionChoice::in_float;
}

double step_tolerance(const Scene& scene, const ClothModel& model)
{
    if (!std::isnan(scene.solver.step_tolerance)) return scene.solver.step_tolerance;
    // Folds that snap in a step are found anew in it, one after the other: to 0.01 the sheet on a sphere takes 13
    // iterations a step with 65 vertices a side and has its steps divided with 129, to 0.1 it takes 4.
    return scene.contact.body && !model.bodies.empty() && is_limp(model) ? 0.1 : 0.01;
}

IntegratorChoice integrator_of(const Scene& scene, const ClothModel& model)
{
    if (scene.solver.integrator != IntegratorChoice::automatic) return scene.solver.integrator;
    // A motion is worth the iterations of BDF2: by `bench work-precision` it comes to 1 % in a third of the time that
    // implicit Euler takes. On limp cloth that folds on bodies both err alike, and BDF2 takes half as many more.
    if (!scene.until().equilibrium)
        return scene.bodies.empty() || !is_limp(model) ? IntegratorChoice::bdf2 : IntegratorChoice::implicit_euler;
    // Where rest depends on the way there, or the steps are to follow an estimate of their error, the way is a motion.
    if (scene.bending.hysteresis || scene.solver.adaptive) return IntegratorChoice::implicit_euler;
    if (scene.bodies.empty()) return IntegratorChoice::quasistatic;
    return moves_near_cloth(scene, model) || scene.solver.load_steps > 1 ? IntegratorChoice::implicit_euler
                                                                         : IntegratorChoice::bdf2;
}

std::vector<std::string> drape_integrators(const Scene& scene, const ClothModel& model)
{
    const std::string first = text_of(integrator_of(scene, model));
    if (!scene.until().equilibrium) return {first};
    const auto chosen = std::ranges::find(integrators(), first, &IntegratorInfo::name);
    const std::string_view next = successor(*chosen, drape_options(scene.solver));
    return next.empty() ? std::vector{first} : std::vector{first, std::string(next)};
}

}  // namespace selvage
