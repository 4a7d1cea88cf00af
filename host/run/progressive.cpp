#include "host/run/progressive.hpp"

#include <chrono>
#include <memory>
#include <optional>

#include "host/mesh/self_intersections.hpp"
#include "host/model/body.hpp"
#include "host/parallel/launch.hpp"
#include "host/run/cloth_picture.hpp"
#include "host/run/garment_sewing.hpp"
#include "host/solver/contact/cloth_body_contact.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

constexpr double most_tangled = 0.01;  // intersections per triangle with which a carried garment may start

// What hangs freely is near its rest in the shape that was carried over: the static energy is tried before any motion.
// Cloth that lies on bodies has folds that only the finer mesh can make, and is not.
DrapeProgress after_carrying(bool lies_on_bodies)
{
    DrapeProgress progress;
    if (!lies_on_bodies) progress.residual = progress.switch_residual;
    return progress;
}

// One coarser cloth on its way to rest.
struct Stage {
    const ClothSettings& settings;
    SceneModel model;
    std::optional<BodyQuery> query;
    std::unique_ptr<Phase> phase;

    Stage(const RunSettings& run, const SceneModel& finest, std::size_t level)
        : settings(run.coarser[level]), model(coarser_model(finest, level))
    {
        if (meets_bodies(settings.draping.params))
            query.emplace(model.cloth_model.bodies, cloth_reach(finest.cloth_model.cloth));
    }

    void start(const PhaseOptions& options, const std::vector<Vec3>& positions, Profile& profile)
    {
        phase.reset();
        phase = std::make_unique<Phase>(model.cloth_model, options, query ? &*query : nullptr, profile, positions,
                                        std::vector<Vec3>{});
    }
};

// Sews a garment at this stage and presses its seams.
PhaseEnd sew_stage(Stage& stage, Profile& profile, const AfterStep& after_step, const std::function<bool()>& stop)
{
    SewingProgress progress;
    PhaseEnd end = PhaseEnd::reached;
    std::vector<Vec3> positions;
    {
        GarmentSewing sewing(
            stage.model, stage.settings, progress, profile, stage.phase, [] {}, stop);
        sewing.start();
        end = sewing.run(after_step);
        positions = stage.phase->positions();
    }
    if (end != PhaseEnd::reached) return end;
    if (!all_welded(progress.welded)) return PhaseEnd::time_limit;
    stage.start(stage.settings.draping, positions, profile);
    PressProgress pressing;
    return press_seams(*stage.phase, stage.settings.sew.step, pressing, after_step);
}

// @param sews  the garment has not been sewn yet
// Returns whether the run goes on.
bool drape_stage(Stage& stage, bool sews, const std::vector<Vec3>& positions, const EquilibriumOptions& options,
                 Clock& clock, DrapeProgress& progress, Profile& profile, const AfterStep& after_step,
                 CoarseStage& report)
{
    bool drapes = false;
    const AfterStep hear = [&](const StepEvent& event) {
        if (drapes) clock.time = event.time;
        report.newton_iterations += event.newton_iterations;
        report.linear_iterations += event.linear_iterations;
        return after_step(event);
    };
    try {
        PhaseEnd end = PhaseEnd::reached;
        if (sews)
            end = sew_stage(stage, profile, hear, options.stop);
        else
            stage.start(stage.settings.draping, positions, profile);
        if (end == PhaseEnd::reached) {
            const std::unique_ptr<Integrator> integrator =
                make_integrator(options.integrator->info().name, *stage.phase);
            EquilibriumOptions own = options;
            own.integrator = integrator.get();
            own.only_balances = stage.query.has_value();
            stage.phase->system().clock() = clock;
            drapes = true;
            end = drape_to_equilibrium(*stage.phase, own, progress, hear);
        }
        if (end == PhaseEnd::stopped) return false;
        report.used = end == PhaseEnd::reached || !sews;
        stage.phase->system().refresh_pairs();
        report.residual = stage.phase->system().residual();
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

std::vector<Vec3> carry_over(const Cloth& fine, const Prolongation& prolongation, const std::vector<Vec3>& positions)
{
    std::vector<Vec3> result(fine.positions.size());
    for_each_item(int(result.size()), [&, to = result.data()](int v) {
        to[v] = Vec3::Zero();
        for (int k = prolongation.offset[v]; k < prolongation.offset[v + 1]; ++k)
            to[v] += prolongation.weight[k] * positions[prolongation.column[k]];
    });
    for (int v : fine.pinned) result[v] = fine.positions[v];
    return result;
}

bool drape_coarse_first(const RunSettings& settings, const SceneModel& model, const EquilibriumOptions& options,
                        Clock& clock, DrapeProgress& progress, Profile& profile, const AfterStep& after_step,
                        CoarseStart& start, const std::function<void()>& after_stage)
{
    for (std::size_t level = settings.coarser.size() - start.stages.size(); level-- > 0;) {
        const TraceScope scope("coarse_" + std::to_string(level + 1));
        const auto begin = std::chrono::steady_clock::now();
        Stage stage(settings, model, level);
        const Cloth &own = stage.model.cloth_model.cloth,
                    &finer = level == 0 ? model.cloth_model.cloth : model.cloth_model.coarser[level - 1];
        const bool carried = !start.positions.empty();
        CoarseStage report{.vertices = int(own.positions.size())};
        if (!drape_stage(stage, model.sews && !carried, carried ? start.positions : own.positions, options, clock,
                         progress, profile, after_step, report))
            return false;
        if (report.used) {
            start.positions = carry_over(finer, model.cloth_model.prolongations[level], stage.phase->positions());
            if (stage.phase->cloth_contact())
                report.intersections = intersections_of(finer, model.cloth_model.bodies, start.positions);
        }
        // Garments can be untangled.
        const double most = model.sews ? most_tangled * double(finer.faces.size()) : 0;
        report.used = report.used && report.intersections <= most;
        if (!report.used) start.positions.clear();
        progress = report.used ? after_carrying(!model.cloth_model.bodies.empty()) : DrapeProgress{};
        report.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        start.stages.push_back(report);
        after_stage();
    }
    return true;
}

}  // namespace selvage
