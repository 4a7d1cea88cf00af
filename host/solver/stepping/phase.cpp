#include "host/solver/stepping/phase.hpp"

#include <algorithm>

#include "host/model/body.hpp"
#include "host/model/cloth_model.hpp"
#include "host/parallel/trace.hpp"
#include "host/solver/state/hysteresis.hpp"
#include "host/solver/state/rest_state.hpp"
#include "host/solver/state/springs.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "host/solver/terms/rules.hpp"

namespace selvage {
namespace {

constexpr double lift_of_edge = 0.5;  // how much further off a body what it pierces is kept, of an edge length

Topology phase_topology(const ClothModel& model, const PhaseOptions& options)
{
    const TraceScope scope("topology");
    Topology topology = make_topology(model.cloth, options.joined);
    add_springs(topology, model.cloth, model.fabrics, springs_of(options.params));
    return topology;
}

ParticleTransfers particle_transfers(const ClothModel& model, const Topology& finest, bool joined)
{
    const TraceScope scope("particle_transfers");
    ParticleTransfers transfers;
    Topology finer = finest;
    for (std::size_t level = 0; level < model.coarser.size(); ++level) {
        Topology coarse = make_topology(model.coarser[level], joined);
        transfers.push_back(particle_transfer(model.transfers[level], coarse, finer));
        finer = std::move(coarse);
    }
    return transfers;
}

}  // namespace

Phase::Phase(const ClothModel& model, const PhaseOptions& options, BodyQuery* query, Profile& profile,
             const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities)
    : options_(options), profile_(profile), topology_(phase_topology(model, options)),
      state_(make_state(topology_, model.cloth, model.fabrics, options.params, positions, velocities)),
      pins_(model.cloth, topology_), edge_length_(typical_edge(model.cloth))
{
    const bool multigrid = options.linear.preconditioner == Preconditioner::multigrid;
    const ParticleTransfers transfers =
        multigrid ? particle_transfers(model, topology_, options.joined) : ParticleTransfers{};
    {
        const TraceScope scope("linear_solver");
        linear_ = options.float_solves ? make_linear_solver_float(state_, options.linear, transfers)
                                       : make_linear_solver_double(state_, options.linear, transfers);
    }
    if (query && !state_.contact_normal.empty())
        contact_ = std::make_unique<FabricContact>(*query, model.bodies, topology_, model.cloth, model.fabrics,
                                                   body_gap(options.params), options.contact_margin,
                                                   meets_itself(options.params));
    if (meets_itself(options.params)) {
        const TraceScope scope("cloth_tree");
        cloth_contact_ = std::make_unique<ClothContact>(
            topology_, model.cloth, query ? model.bodies : std::vector<Body>{}, cloth_gap(options.params),
            particle_friction(topology_, model.cloth, model.fabrics));
    }
    if (cloth_contact_ && contact_ && contact_->motion_end() > 0)
        cloth_contact_->set_carry([this](State& state, double time) { contact_->move_to(state, time); });
    if (cloth_contact_ && contact_) contact_->lift(cloth_contact_->pierced(), lift_of_edge * edge_length_);
    for (const Rule& rule : all_rules())
        if (rule.is_active(options.params)) rules_.push_back(&rule);
    // Where a rule stands for contact there is none while a step is solved.
    ContactField* felt = options.params.velocity_rule.gap > 0 ? nullptr : contact_.get();
    newton_ = std::make_unique<Newton>(state_, options_.params, *linear_, felt, cloth_contact_.get(), profile);
    take_hold();
}

void Phase::start_over(const ClothModel& model, const std::vector<Vec3>& positions)
{
    place_particles(state_, topology_, model.cloth, model.fabrics, positions, {});
    std::fill(state_.friction_anchor.begin(), state_.friction_anchor.end(), 0);
    std::fill(state_.friction_limit.begin(), state_.friction_limit.end(), 0);
    if (!state_.hinge_hysteresis.empty()) fill_hysteresis(state_, topology_, model.cloth, model.fabrics);
    if (cloth_contact_) {
        cloth_contact_->start_step();
        cloth_contact_->memory().clear();
    }
    take_hold();
}

// Cloth that lies on a body from the start is held by friction in its first step already.
void Phase::take_hold()
{
    look_around();
    if (!contact_) return;
    newton_->list_pairs();
    settle_friction(state_, options_.params);
    newton_->terms().evaluate_forces(false);
    hold_by_friction(state_, options_.params);
}

void Phase::look_around()
{
    const TraceScope scope("look_around");
    if (contact_) contact_->update(state_);
    if (cloth_contact_) cloth_contact_->begin(state_);
}

double Phase::motion_end() const { return std::max(pins_.end(), contact_ ? contact_->motion_end() : 0.0); }

double Phase::longest_step(double time, double room) const
{
    const double pinned = pins_.longest_step(time, room, 0.5 * (body_gap(options_.params) + options_.contact_margin));
    return contact_ ? contact_->longest_step(time, pinned) : pinned;
}

bool Phase::apply_rules(double dt)
{
    if (rules_.empty()) return false;
    if (contact_) profile_.timed("body_query", state_.size.vertex_count, 0, [&] { contact_->update(state_); });
    for (const Rule* rule : rules_) {
        const int count = rule->item_count(state_.size);
        profile_.timed(rule->name, count, std::int64_t(count) * rule->bytes_per_item,
                       [&] { rule->apply(state_, options_.params, dt); });
    }
    return contact_ && contact_->contact_count() > 0;
}

void Phase::place(double time)
{
    if (contact_) contact_->place(state_, time);
    if (cloth_contact_) cloth_contact_->place_bodies(state_, time);
}

void Phase::move_to(double time)
{
    if (cloth_contact_) {  // it moves them, as far as the cloth makes way
        cloth_contact_->aim(pins_.places(time), time);
        return;
    }
    if (contact_) contact_->move_to(state_, time);
    pins_.move_to(state_, time);
}

}  // namespace selvage
