#include "host/scene/plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "host/model/body.hpp"
#include "host/scene/features.hpp"
#include "host/scene/run_settings.hpp"
#include "host/solver/linear/linear_traffic.hpp"
#include "host/solver/state/springs.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "host/solver/terms/velocity_filters.hpp"

namespace selvage {
namespace {

// Entries of the plate's matrix per hinge on irregular meshes, where it is fullest.
constexpr int couplings_per_hinge = 28;

// Of the matrix with its places and the preconditioner; see LinearSolver.
std::size_t solver_bytes(const Scene& scene, const ClothModel& model, const Topology& topology, const mesh_sizes& size,
                         const PhaseOptions& options, const FieldSet& fields)
{
    const std::size_t scalar = solve_precision(scene, model) == PrecisionChoice::in_float ? 4 : 8;
    std::size_t places = 0;
#define ADD_PLACES(kind, corners)                 \
    if (fields[std::size_t(Field::kind##_slots)]) \
        places += sizeof(std::uint16_t) * corners * corners * std::size_t(size.kind##_count);
    ELEMENT_KINDS(ADD_PLACES)
#undef ADD_PLACES
    ParticleProlongations prolongations;
    if (options.linear.preconditioner == Preconditioner::multigrid)
        prolongations = particle_prolongations(model, topology, options);
    const std::size_t turns = fields[std::size_t(Field::hinge_slope)] ? 2 * std::size_t(size.hinge_count) * scalar : 0;
    return linear_solver_bytes(pattern_of(topology, fields[std::size_t(Field::hinge_slots)]), prolongations, scalar) +
           places + turns;
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
    const PhaseOptions options = phase_options(scene, model, stage == RunStage::sew);
    phase.params = options.params;
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
    const FieldSet fields = required_fields(phase.params);
    phase.field_bytes = field_bytes(size, fields);
    phase.solver_bytes = solver_bytes(scene, cloth, topology, size, options, fields);
    phase.memory = phase_memory({cloth, topology, size, fields, phase.params, phase.solver_bytes});
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

// What is there at once when a run takes most: the larger phase, with the coarser cloth that is draped meanwhile, and
// the results of its end.
std::vector<MemoryPart> whole_memory(const Scene& scene, const SceneModel& model, const RunPlan& plan,
                                     const MemoryPart& present)
{
    const auto less = [](const PhasePlan& a, const PhasePlan& b) {
        return total_bytes(a.memory) < total_bytes(b.memory);
    };
    std::vector<MemoryPart> memory{present};
    const PhasePlan& largest = *std::max_element(plan.phases.begin(), plan.phases.end(), less);
    memory.insert(memory.end(), largest.memory.begin(), largest.memory.end());
    if (plan.coarse_start) {
        // What it frees lies between arrays that stay: little of it is there again for what comes at the end.
        const SceneModel coarse = coarser_model(model, 0);
        memory.push_back({"coarse_start", total_bytes(plan_phase(scene, coarse, RunStage::drape).memory)});
    }
    const std::vector<MemoryPart> last = end_memory(scene, model.cloth_model);
    memory.insert(memory.end(), last.begin(), last.end());
    return memory;
}

bool is_active(const RunPlan& plan, std::string_view feature)
{
    return std::find(plan.active.begin(), plan.active.end(), feature) != plan.active.end();
}

}  // namespace

RunPlan make_plan(const Scene& scene, const SceneModel& model)
{
    RunPlan plan;
    const MemoryPart present = present_memory();  // before the plan itself takes and gives back any
    plan.integrators = drape_integrators(scene, model.cloth_model);
    if (model.sews) plan.phases.push_back(plan_phase(scene, model, RunStage::sew));
    plan.phases.push_back(plan_phase(scene, model, RunStage::drape));
    const FeatureCase drape{scene, model, false};
    for (const Term& term : all_terms()) list_feature(term.name, drape, plan);
    for (const VelocityFilter& filter : all_velocity_filters()) list_feature(filter.name, drape, plan);
    for (const Feature& feature : all_features())
        if (!is_kernel(feature.name)) list_feature(feature.name, drape, plan, feature.is_listed);
    plan.embree = is_active(plan, "embree");
    plan.coarse_start = is_active(plan, "coarse_start");

    plan.memory = whole_memory(scene, model, plan, present);
    plan.peak_bytes = total_bytes(plan.memory);
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
