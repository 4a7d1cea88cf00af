#include "host/progressive.hpp"

#include <chrono>

#include "host/cloth_picture.hpp"
#include "host/collision/self_intersections.hpp"
#include "host/scene_phase.hpp"
#include "host/solver/launch.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

// The cloth `level` of a model with what is coarser than it.
ClothModel model_from(const ClothModel& model, std::size_t level)
{
    const auto from = std::ptrdiff_t(level) + 1;
    return {model.coarser[level],
            {model.coarser.begin() + from, model.coarser.end()},
            {model.transfers.begin() + from, model.transfers.end()},
            model.fabrics,
            model.bodies};
}

// A shape that was carried over is near its rest: the static energy is tried before any motion.
DrapeProgress near_rest(double time)
{
    DrapeProgress progress;
    progress.time = time;
    progress.residual = progress.switch_residual;
    return progress;
}

// Returns whether the run goes on.
bool drape_stage(Phase& phase, const EquilibriumOptions& options, DrapeProgress& progress, const AfterStep& after_step,
                 CoarseStage& stage)
{
    const AfterStep hear = [&](const StepEvent& event) {
        stage.newton_iterations += event.newton_iterations;
        stage.linear_iterations += event.linear_iterations;
        return after_step(event);
    };
    try {
        if (drape_to_equilibrium(phase, options, progress, hear) == PhaseEnd::stopped) return false;
        stage.residual = phase.newton().static_residual();
    } catch (const DivergenceError&) {
        stage.used = false;
    }
    return true;
}

int intersections_of(const Cloth& cloth, const std::vector<Vec3>& positions)
{
    const TraceScope scope("self_intersections");
    return int(self_intersections(positions, shared_faces(cloth, make_topology(cloth, true))).size());
}

}  // namespace

std::string why_no_coarse_start(const Scene& scene, const SceneModel& model)
{
    const std::string integrator = integrator_of(scene);
    if (!scene.solver.progressive) return "solver.progressive is false";
    if (scene.solver.until != "equilibrium") return "the run shows a motion (solver.until)";
    if (integrator != "implicit_euler" && integrator != "static") return "solver.integrator asks for another way to rest";
    if (scene.moves()) return "held vertices or bodies move, and the cloth has to follow";
    if (scene.has_garment()) return "a garment is sewn first";
    if (!model.model.bodies.empty()) return "there are bodies, and what the cloth meets first decides where it lies";
    if (scene.solver.load_steps > 1) return "the weight grows in steps (solver.load_steps)";
    if (scene.bending.hysteresis) return "bending hysteresis remembers the way (bending.hysteresis)";
    if (model.model.coarser.empty()) return "there are no coarser meshes of the cloth";
    return "";
}

std::vector<Vec3> carry_over(const Cloth& fine, const Transfer& transfer, const std::vector<Vec3>& positions)
{
    std::vector<Vec3> result(fine.positions.size());
    for_each_item(int(result.size()), [&, to = result.data()](int v) {
        to[v] = Vec3::Zero();
        for (int k = transfer.offset[v]; k < transfer.offset[v + 1]; ++k)
            to[v] += transfer.weight[k] * positions[transfer.column[k]];
    });
    for (int v : fine.pinned) result[v] = fine.positions[v];
    return result;
}

CoarseStart drape_coarse_first(const Scene& scene, const SceneModel& model, const PhasePlan& plan,
                               const EquilibriumOptions& options, DrapeProgress& progress, Profile& profile,
                               const AfterStep& after_step)
{
    EquilibriumOptions coarse = options;
    coarse.integrator = nullptr;
    CoarseStart start;
    start.positions = model.model.coarser.back().positions;
    for (std::size_t level = model.model.coarser.size(); level-- > 0;) {
        const TraceScope scope("coarse_" + std::to_string(level + 1));
        const auto begin = std::chrono::steady_clock::now();
        SceneModel own;
        own.model = model_from(model.model, level);
        const Cloth& finer = level == 0 ? model.model.cloth : model.model.coarser[level - 1];
        Phase phase(own.model, phase_options(scene, own, plan), nullptr, profile, start.positions, {});
        CoarseStage stage{.vertices = phase.state().size.vertex_count};
        start.stopped = !drape_stage(phase, coarse, progress, after_step, stage);
        if (start.stopped) return start;
        start.positions = carry_over(finer, model.model.transfers[level], phase.positions());
        if (stage.used && phase.cloth_contact()) stage.intersections = intersections_of(finer, start.positions);
        stage.used = stage.used && stage.intersections == 0;
        if (!stage.used) start.positions = finer.positions;
        progress = stage.used ? near_rest(progress.time) : DrapeProgress{.time = progress.time};
        stage.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        start.stages.push_back(stage);
    }
    return start;
}

}  // namespace selvage
