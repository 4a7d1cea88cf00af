#include "host/scene/plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "host/model/body.hpp"
#include "host/scene/features.hpp"
#include "host/scene/run_settings.hpp"
#include "host/solver/state/springs.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "host/solver/terms/velocity_filters.hpp"

namespace selvage {
namespace {

// Entries of the plate's matrix per hinge on irregular meshes, where it is fullest.
constexpr int couplings_per_hinge = 28;

std::size_t solver_estimate(const Scene& scene, const Cloth& cloth, const mesh_sizes& size, bool levels)
{
    const std::size_t scalar = solve_precision(scene, cloth) == PrecisionChoice::in_float ? 4 : 8;
    const std::size_t blocks = std::size_t(size.vertex_count) + 2 * std::size_t(size.face_count) * 3 / 2 +
                               2 * std::size_t(size.hinge_count) + 2 * std::size_t(size.spring_count);
    const std::size_t matrix = blocks * (9 * scalar + 4) + std::size_t(size.vertex_count) * (9 + 15) * scalar;
    std::size_t places = 0;
#define ADD_PLACES(kind, corners) places += sizeof(std::uint16_t) * corners * corners * std::size_t(size.kind##_count);
    ELEMENT_KINDS(ADD_PLACES)
#undef ADD_PLACES
    // Coarse matrices are a third of the finest one; the plan of their products holds nine entries per fine block.
    return matrix + places + (levels ? matrix / 3 + 9 * 4 * blocks * 4 / 3 : 0);
}

template <class Kernels>
void add_launches(const Kernels& kernels, const mesh_sizes& size, PhasePlan& phase)
{
    for (const auto& kernel : kernels)
        if (kernel.is_active(phase.params))
            phase.launches.push_back({std::string(kernel.name), std::string(kind_name(kernel.per)),
                                      kernel.item_count(size),
                                      std::size_t(kernel.item_count(size)) * std::size_t(kernel.bytes_per_item)});
}

PhasePlan plan_phase(const Scene& scene, const SceneModel& model, RunStage stage)
{
    PhasePlan phase;
    phase.stage = stage;
    phase.params = phase_params(scene, model, stage == RunStage::sew);
    phase.queries_bodies = meets_bodies(phase.params);
    const ClothModel& cloth = model.cloth_model;
    Topology topology = make_topology(cloth.cloth, stage != RunStage::sew);
    add_springs(topology, cloth.cloth, cloth.fabrics, springs_of(phase.params));
    const bool plate = phase.params.plate.scale > 0;
    const mesh_sizes size = topology_sizes(topology, int(cloth.fabrics.size()),
                                           plate ? couplings_per_hinge * int(topology.hinges.size()) : 0);
    add_launches(all_terms(), size, phase);
    add_launches(all_velocity_filters(), size, phase);
    if (phase.queries_bodies) phase.launches.push_back({"body_query", "vertex", size.vertex_count, 0});
    phase.field_bytes = field_bytes(size, required_fields(phase.params));
    phase.solver_bytes = solver_estimate(scene, cloth.cloth, size, !cloth.coarser.empty());
    return phase;
}

// Notes that a feature is in use, or why not. A term may be needed in one phase only.
void list_feature(std::string_view name, const FeatureCase& with, RunPlan& plan, bool is_listed = true)
{
    const bool launched = std::any_of(plan.phases.begin(), plan.phases.end(), [&](const PhasePlan& phase) {
        return std::any_of(phase.launches.begin(), phase.launches.end(),
                           [&](const PlannedLaunch& launch) { return launch.name == name; });
    });
    const std::string reason = launched ? "" : why_off(with, name, plan.phases.back().params);
    if (!reason.empty())
        plan.skipped.push_back({std::string(name), reason});
    else if (is_listed)
        plan.active.emplace_back(name);
}

bool is_active(const RunPlan& plan, std::string_view feature)
{
    return std::find(plan.active.begin(), plan.active.end(), feature) != plan.active.end();
}

}  // namespace

RunPlan make_plan(const Scene& scene, const SceneModel& model)
{
    RunPlan plan;
    plan.integrators = drape_integrators(scene);
    if (model.sews) plan.phases.push_back(plan_phase(scene, model, RunStage::sew));
    plan.phases.push_back(plan_phase(scene, model, RunStage::drape));
    const FeatureCase drape{scene, model, false};
    for (const Term& term : all_terms()) list_feature(term.name, drape, plan);
    for (const VelocityFilter& filter : all_velocity_filters()) list_feature(filter.name, drape, plan);
    for (const Feature& feature : all_features())
        if (!is_kernel(feature.name)) list_feature(feature.name, drape, plan, feature.is_listed);
    plan.embree = is_active(plan, "embree");
    plan.coarse_start = is_active(plan, "coarse_start");

    std::size_t body_bytes = 0;
    for (const Body& body : model.cloth_model.bodies)
        body_bytes += body.mesh.faces.size() * 400 + (body.motion ? body.motion->bytes() : 0);
    for (const PhasePlan& phase : plan.phases)
        plan.peak_bytes = std::max(plan.peak_bytes, phase.field_bytes + phase.solver_bytes);
    plan.peak_bytes += model.cloth_model.cloth.positions.size() * 500 + body_bytes + (std::size_t(100) << 20);
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
