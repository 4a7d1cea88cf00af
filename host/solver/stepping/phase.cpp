#include "host/solver/stepping/phase.hpp"

#include <algorithm>

#include "host/model/body.hpp"
#include "host/model/cloth_model.hpp"
#include "host/parallel/trace.hpp"
#include "host/solver/state/hysteresis.hpp"
#include "host/solver/state/rest_state.hpp"
#include "host/solver/state/springs.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "host/solver/terms/velocity_filters.hpp"

namespace selvage {
namespace {

constexpr double lift_of_edge = 0.5;  // how much further off a body what it pierces is kept, of an edge length

Topology phase_topology(const ClothModel& model, const PhaseOptions& options)
{
    const TraceScope scope("topology");
    Topology topology = options.joined ? make_topology(model.cloth, true) : make_topology(model.cloth, options.welded);
    add_springs(topology, model.cloth, model.fabrics, springs_of(options.params));
    return topology;
}

Vec3 down(const Params& params)
{
    const auto& gravity = params.gravity;
    return {gravity.acceleration_x, gravity.acceleration_y, gravity.acceleration_z};
}

Surroundings surroundings(const ClothModel& model, const PhaseOptions& options, BodyQuery* query,
                          const Topology& topology, double edge_length)
{
    Surroundings around;
    ContactHardness hardness;
    if (options.local_stiffness && contact_stiffness(options.params) > 0)
        hardness = local_hardness(topology, model.cloth, model.fabrics, model.bodies, down(options.params),
                                  contact_stiffness(options.params), body_gap(options.params));
    around.contact_margin = options.contact_margin;
    around.pins.emplace(model.cloth, topology);
    around.air = options.air;
    if (query && required_fields(options.params)[std::size_t(Field::contact_normal)])
        around.bodies = std::make_shared<ClothBodyContact>(*query, model.bodies, topology, model.cloth, model.fabrics,
                                                           body_gap(options.params), options.contact_margin,
                                                           meets_itself(options.params), hardness);
    if (meets_itself(options.params)) {
        const TraceScope scope("cloth_tree");
        around.cloth = std::make_unique<ClothContact>(
            topology, model.cloth, query ? model.bodies : std::vector<Body>{},
            ContactGaps(topology, model.cloth, model.fabrics, cloth_gap(options.params)),
            particle_friction(topology, model.cloth, model.fabrics), std::move(hardness.of_pairs));
    }
    if (around.cloth && around.bodies)
        around.bodies->lift(around.cloth->crossings().pierced, lift_of_edge * edge_length);
    return around;
}

std::unique_ptr<LinearSolver> linear_solver(const ClothModel& model, const PhaseOptions& options,
                                            const Topology& topology, const State& state)
{
    const bool multigrid = options.linear.preconditioner == Preconditioner::multigrid;
    const ParticleProlongations prolongations =
        multigrid ? particle_prolongations(model, topology, options) : ParticleProlongations{};
    const TraceScope scope("linear_solver");
    return options.float_solves ? make_linear_solver_float(state, options.linear, prolongations)
                                : make_linear_solver_double(state, options.linear, prolongations);
}

}  // namespace

ParticleProlongations particle_prolongations(const ClothModel& model, const Topology& finest,
                                             const PhaseOptions& options)
{
    const TraceScope scope("particle_prolongations");
    ParticleProlongations prolongations;
    Topology finer = finest;
    for (std::size_t level = 0; level < model.coarser.size(); ++level) {
        const Cloth& cloth = model.coarser[level];
        Topology coarse = options.joined ? make_topology(cloth, true)
                                         : make_topology(cloth, coarser_welds(model.cloth, options.welded, cloth));
        prolongations.push_back(particle_prolongation(model.prolongations[level], coarse, finer));
        finer = std::move(coarse);
    }
    return prolongations;
}

Phase::Phase(const ClothModel& model, const PhaseOptions& options, BodyQuery* query, Profile& profile,
             const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities)
    : topology_(phase_topology(model, options)), edge_length_(typical_edge(model.cloth)),
      system_(make_state(topology_, model.cloth, model.fabrics, options.params, positions, velocities), options.params,
              profile, surroundings(model, options, query, topology_, edge_length_)),
      linear_(linear_solver(model, options, topology_, system_.state())), newton_(system_, *linear_)
{
    system_.find_contacts();
    system_.hold_by_friction();
}

void Phase::start_over(const ClothModel& model, const std::vector<Vec3>& positions)
{
    State& state = system_.state();
    place_particles(state, topology_, model.cloth, model.fabrics, positions, {});
    std::fill(state.friction_anchor.begin(), state.friction_anchor.end(), 0);
    std::fill(state.friction_limit.begin(), state.friction_limit.end(), 0);
    if (!state.hinge_hysteresis.empty()) fill_hysteresis(state, topology_, model.cloth, model.fabrics);
    system_.forget_searches();
    if (system_.cloth_contact()) system_.cloth_contact()->set_memory({});
    system_.find_contacts();
    system_.hold_by_friction();
}

}  // namespace selvage
