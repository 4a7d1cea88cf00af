#include "host/run/progressive.hpp"

#include <chrono>
#include <memory>
#include <optional>

#include "host/mesh/self_intersections.hpp"
#include "host/model/body.hpp"
#include "host/parallel/launch.hpp"
#include "host/run/cloth_picture.hpp"
#include "host/scene/plan_reasons.hpp"
#include "host/scene/scene_phase.hpp"
#include "host/solver/contact/fabric_contact.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

constexpr double most_tangled = 0.01;  // intersections per triangle with which a carried garment may start

// What hangs freely is near its rest in the shape that was carried over: the static energy is tried before any motion.
// Cloth that lies on bodies has folds that only the finer mesh can make, and is not.
DrapeProgress after_carrying(double time, bool lies_on_bodies)
{
    DrapeProgress progress;
    progress.time = time;
    if (!lies_on_bodies) progress.residual = progress.switch_residual;
    return progress;
}

// One coarser cloth on its way to rest.
struct Stage {
    const Scene& scene;
    SceneModel model;
    RunPlan plan = make_plan(scene, model);
    std::optional<BodyQuery> query;
    std::unique_ptr<Phase> phase;

    Stage(const Scene& of, const SceneModel& finest, std::size_t level) : scene(of), model(coarser_model(finest, level))
    {
        if (plan.phases.back().queries_bodies) query.emplace(model.model.bodies, cloth_reach(finest.model.cloth));
    }

    void start(const PhasePlan& with, const std::vector<Vec3>& positions, Profile& profile)
    {
        phase.reset();
        phase = std::make_unique<Phase>(model.model, phase_options(scene, model, with), query ? &*query : nullptr,
                                        profile, positions, std::vector<Vec3>{});
    }
};

// Sews a garment at this stage and presses its seams.
PhaseEnd sew_stage(Stage& stage, Profile& profile, const AfterStep& after_step)
{
    const SewingOptions options = sewing_options(stage.scene, stage.plan);
    SewingProgress sewing;
    stage.start(stage.plan.phases.front(), stage.model.model.cloth.positions, profile);
    const PhaseEnd end = sew(*stage.phase, options, sewing, after_step);
    if (end != PhaseEnd::reached) return end;
    stage.start(stage.plan.phases.back(), stage.phase->positions(), profile);
    PressProgress pressing;
    return press_seams(*stage.phase, options.step, pressing, after_step);
}

// @param sews  the garment has not been sewn yet
// Returns whether the run goes on.
bool drape_stage(Stage& stage, bool sews, const std::vector<Vec3>& positions, const EquilibriumOptions& options,
                 DrapeProgress& progress, Profile& profile, const AfterStep& after_step, CoarseStage& report)
{
    const AfterStep hear = [&](const StepEvent& event) {
        report.newton_iterations += event.newton_iterations;
        report.linear_iterations += event.linear_iterations;
        return after_step(event);
    };
    try {
        PhaseEnd end = PhaseEnd::reached;
        if (sews)
            end = sew_stage(stage, profile, hear);
        else
            stage.start(stage.plan.phases.back(), positions, profile);
        if (end == PhaseEnd::reached) {
            const std::unique_ptr<Integrator> integrator = make_integrator(integrator_of(stage.scene), *stage.phase);
            EquilibriumOptions own = options;
            own.integrator = integrator.get();
            own.only_balances = stage.query.has_value();
            end = drape_to_equilibrium(*stage.phase, own, progress, hear);
        }
        if (end == PhaseEnd::stopped) return false;
        report.used = end == PhaseEnd::reached || !sews;
        report.residual = stage.phase->newton().static_residual();
    } catch (const DivergenceError&) {
        report.used = false;
    }
    return true;
}

// Of a cloth with itself, and with the bodies whose surfaces its faces must not meet.
int intersections_of(const Cloth& cloth, const std::vector<Body>& bodies, const std::vector<Vec3>& positions)
{
    const TraceScope scope("intersections");
    const std::vector<Face> faces = shared_faces(cloth, make_topology(cloth, true));
    std::size_t count = self_intersections(positions, faces).size();
    for (const Body& body : bodies)
        if (!clear_by_vertices(body, cloth)) count += mutual_intersections(positions, faces, body.mesh).size();
    return int(count);
}

}  // namespace

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

CoarseStart drape_coarse_first(const Scene& scene, const SceneModel& model, const EquilibriumOptions& options,
                               DrapeProgress& progress, Profile& profile, const AfterStep& after_step)
{
    CoarseStart start;
    for (std::size_t level = levels_used(scene, model); level-- > 0;) {
        const TraceScope scope("coarse_" + std::to_string(level + 1));
        const auto begin = std::chrono::steady_clock::now();
        Stage stage(scene, model, level);
        const Cloth &own = stage.model.model.cloth,
                    &finer = level == 0 ? model.model.cloth : model.model.coarser[level - 1];
        const bool carried = !start.positions.empty();
        CoarseStage report{.vertices = int(own.positions.size())};
        start.stopped = !drape_stage(stage, model.sews && !carried, carried ? start.positions : own.positions, options,
                                     progress, profile, after_step, report);
        if (start.stopped) return start;
        if (report.used) {
            start.positions = carry_over(finer, model.model.transfers[level], stage.phase->positions());
            if (stage.phase->cloth_contact())
                report.intersections = intersections_of(finer, model.model.bodies, start.positions);
        }
        // Garments can be untangled.
        const double most = model.sews ? most_tangled * double(finer.faces.size()) : 0;
        report.used = report.used && report.intersections <= most;
        if (!report.used) start.positions.clear();
        progress = report.used ? after_carrying(progress.time, !model.model.bodies.empty())
                               : DrapeProgress{.time = progress.time};
        report.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        start.stages.push_back(report);
    }
    return start;
}

}  // namespace selvage
