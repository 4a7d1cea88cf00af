#include "host/scene/plan.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/model/body.hpp"
#include "host/scene/plan_reasons.hpp"
#include "host/scene/scene_params.hpp"
#include "host/solver/state/springs.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "host/solver/terms/rules.hpp"

namespace selvage {
namespace {

// Entries of the plate's matrix per hinge on irregular meshes, where it is fullest.
constexpr int couplings_per_hinge = 28;

std::size_t solver_estimate(const Scene& scene, const mesh_sizes& size, bool levels)
{
    const std::size_t scalar = scene.solver.precision == "float" ? 4 : 8;
    const std::size_t blocks = std::size_t(size.vertex_count) + 2 * std::size_t(size.face_count) * 3 / 2 +
                               2 * std::size_t(size.hinge_count) + 2 * std::size_t(size.spring_count);
    const std::size_t matrix = blocks * (9 * scalar + 4) + std::size_t(size.vertex_count) * (9 + 15) * scalar;
    const std::size_t places = 2 * (9 * std::size_t(size.face_count) + 16 * std::size_t(size.hinge_count) +
                                    4 * std::size_t(size.spring_count));
    // Coarse matrices are a third of the finest one; the plan of their products holds nine entries per fine block.
    return matrix + places + (levels ? matrix / 3 + 9 * 4 * blocks * 4 / 3 : 0);
}

PhasePlan plan_phase(const Scene& scene, const SceneModel& model, bool sewing)
{
    PhasePlan phase;
    phase.name = sewing ? "sew" : "drape";
    phase.params = phase_params(scene, model, sewing);
    phase.joined = !sewing;
    phase.queries_bodies = meets_bodies(phase.params);
    Topology topology = make_topology(model.model.cloth, phase.joined);
    add_springs(topology, model.model.cloth, model.model.fabrics, springs_of(phase.params));
    const bool plate = phase.params.plate.scale > 0;
    const mesh_sizes size = topology_sizes(topology, int(model.model.fabrics.size()),
                                           plate ? couplings_per_hinge * int(topology.hinges.size()) : 0);
    for (const Term& term : all_terms())
        if (term.is_active(phase.params))
            phase.launches.push_back({std::string(term.name), std::string(kind_name(term.per)), term.item_count(size),
                                      std::size_t(term.item_count(size)) * std::size_t(term.bytes_per_item)});
    for (const Rule& rule : all_rules())
        if (rule.is_active(phase.params))
            phase.launches.push_back({std::string(rule.name), std::string(kind_name(rule.per)), rule.item_count(size),
                                      std::size_t(rule.item_count(size)) * std::size_t(rule.bytes_per_item)});
    if (phase.queries_bodies) phase.launches.push_back({"body_query", "vertex", size.vertex_count, 0});
    phase.field_bytes = field_bytes(size, required_fields(phase.params));
    phase.solver_bytes = solver_estimate(scene, size, !model.model.coarser.empty());
    return phase;
}

double bodies_end(const std::vector<Body>& bodies)
{
    double end = 0;
    for (const Body& body : bodies)
        if (body.motion) end = std::max(end, body.motion->end());
    return end;
}

}  // namespace

RunPlan make_plan(const Scene& scene, const SceneModel& model)
{
    RunPlan plan;
    if (model.sews) plan.phases.push_back(plan_phase(scene, model, true));
    plan.phases.push_back(plan_phase(scene, model, false));
    for (const Term& term : all_terms()) {
        const bool used = std::any_of(plan.phases.begin(), plan.phases.end(),
                                      [&](const PhasePlan& phase) { return term.is_active(phase.params); });
        if (used)
            plan.active.push_back(std::string(term.name));
        else
            plan.skipped.push_back({std::string(term.name), absence(scene, model, term.name)});
    }
    for (const Rule& rule : all_rules())
        if (rule.is_active(plan.phases.back().params))
            plan.active.push_back(std::string(rule.name));
        else
            plan.skipped.push_back(
                {std::string(rule.name), absence_of_contact(scene, !model.model.bodies.empty(), rule.name)});
    const bool queries = plan.phases.back().queries_bodies;
    const bool queries_meshes = queries && std::any_of(model.model.bodies.begin(), model.model.bodies.end(),
                                                       [](const Body& body) { return body.kind == Body::Kind::mesh; });
    plan.embree = queries_meshes || scene.output.picture;
    if (plan.embree)
        plan.active.push_back("embree");
    else
        plan.skipped.push_back({"embree", queries ? "all bodies have closed forms, and no picture is drawn"
                                                  : "no body is queried and no picture is drawn"});
    if (scene.output.picture)
        plan.active.push_back("picture");
    else
        plan.skipped.push_back({"picture", "output.picture is false"});
    const std::string no_coarse_start = why_no_coarse_start(scene, model);
    plan.coarse_start = no_coarse_start.empty();
    if (plan.coarse_start)
        plan.active.push_back("coarse_start");
    else
        plan.skipped.push_back({"coarse_start", no_coarse_start});
    if (!model.sews) plan.skipped.push_back({"sew", "there are no seams"});
    if (scene.wind.velocity.isZero()) plan.skipped.push_back({"wind", "wind.velocity is zero"});
    const double body_end = bodies_end(model.model.bodies);
    if (!queries || body_end == 0)
        plan.skipped.push_back({"body_motion", queries ? "no body has keyframes or a sequence" : "no body is queried"});
    else
        plan.active.push_back("body_motion");
    if (model.model.cloth.pin_motions.empty())
        plan.skipped.push_back({"pin_motion", "there is no [[pins.motion]]"});
    else
        plan.active.push_back("pin_motion");

    std::size_t body_bytes = 0;
    for (const Body& body : model.model.bodies)
        body_bytes += body.mesh.faces.size() * 400 + (body.motion ? body.motion->bytes() : 0);
    for (const PhasePlan& phase : plan.phases)
        plan.peak_bytes = std::max(plan.peak_bytes, phase.field_bytes + phase.solver_bytes);
    plan.peak_bytes += model.model.cloth.positions.size() * 500 + body_bytes + (std::size_t(100) << 20);
    return plan;
}

void check_memory(const Scene& scene, const RunPlan& plan)
{
    const double limit = memory_limit(scene);
    if (double(plan.peak_bytes) <= limit) return;
    const std::string key = scene.has_garment() ? "garment.resolution" : "sheet[0].resolution";
    throw InputError(scene.place(key),
                     fmt::format("a resolution whose run needs about {:.1f} GiB", double(plan.peak_bytes) / (1 << 30)),
                     fmt::format("at most {:.1f} GiB (solver.memory_limit)", limit / (1 << 30)));
}

}  // namespace selvage
