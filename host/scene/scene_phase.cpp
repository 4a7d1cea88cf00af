#include "host/scene/scene_phase.hpp"

namespace selvage {
namespace {

// Vertices. The ratio of the stiffest to the softest motion grows with the square of the resolution: where it nears the
// 16 million steps of single precision, directions of descent get lost in rounding.
constexpr std::size_t most_in_float = 500000;

}  // namespace

PhaseOptions phase_options(const Scene& scene, const SceneModel& model, const PhasePlan& plan)
{
    PhaseOptions options;
    options.params = plan.params;
    options.joined = plan.joined;
    options.float_solves = solve_precision(scene, model.model.cloth) == "float";
    options.linear.max_iterations = scene.solver.linear_iterations;
    const bool levels = !model.model.coarser.empty() && scene.solver.preconditioner != "block_jacobi";
    options.linear.preconditioner = levels ? Preconditioner::multigrid : Preconditioner::block_jacobi;
    return options;
}

SewingOptions sewing_options(const Scene& scene, const RunPlan& plan)
{
    SewingOptions options;
    options.step = scene.solver.step;
    options.closed = scene.seams.closed;
    options.energy_tolerance = scene.solver.energy_tolerance;
    options.max_time = scene.seams.max_time;
    options.first_stiffness = plan.phases.front().params.seam.stiffness;
    return options;
}

std::string solve_precision(const Scene& scene, const Cloth& cloth)
{
    if (scene.solver.precision != "automatic") return scene.solver.precision;
    return cloth.positions.size() > most_in_float ? "double" : "float";
}

std::string integrator_of(const Scene& scene)
{
    if (scene.solver.integrator != "automatic") return scene.solver.integrator;
    // Cloth that folds on bodies takes BDF2 twice the iterations of implicit Euler; where the motion counts it is worth
    // them.
    if (scene.solver.until != "equilibrium") return scene.bodies.empty() ? "bdf2" : "implicit_euler";
    // Where rest depends on the way there, or the steps are to follow an estimate of their error, the way is a motion.
    if (scene.bending.hysteresis || scene.solver.adaptive) return "implicit_euler";
    if (scene.bodies.empty()) return "static";
    return scene.moves() || scene.solver.load_steps > 1 ? "implicit_euler" : "bdf2";
}

}  // namespace selvage
