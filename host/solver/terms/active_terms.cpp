#include "host/solver/terms/active_terms.hpp"

#include "host/parallel/launch.hpp"
#include "host/solver/state/vectors.hpp"
#include "host/solver/terms/traffic.hpp"
#include "kernels/curve_way.h"

namespace selvage {
ActiveTerms::ActiveTerms(State& state, const Params& params, Profile& profile)
    : state_(state), params_(params), profile_(profile)
{
    for (const Term& term : all_terms()) {
        if (!term.is_active(params)) continue;
        (term.nature == Nature::conservative ? conservative_ : dissipative_).push_back(&term);
        const auto bytes = [&](TermPart part) { return std::int64_t(term_bytes(term, state, part)); };
        traffic_[&term] = {bytes(TermPart::value), bytes(TermPart::force), bytes(TermPart::stiffness)};
    }
}

// Runs one part of a term, with what it takes and moves in the profile.
template <class Work>
auto ActiveTerms::timed(const Term& term, std::string_view name, std::int64_t bytes, const Work& work) const
{
    const int whole = term.item_count(state_.size), items = items_of(state_, term.per).count;
    return profile_.timed(name, items, items == whole ? bytes : bytes * items / whole, work);
}

void ActiveTerms::sum_forces(bool dissipative) const
{
    const TraceScope scope("forces");
    clear_forces(state_);
    const auto add = [&](const Term* term) {
        timed(*term, term->name, traffic_.at(term).force, [&] { term->add_force(state_, params_); });
    };
    for (const Term* term : conservative_) add(term);
    if (dissipative)
        for (const Term* term : dissipative_) add(term);
    const Items vertices = items_of(state_, ItemKind::vertex);
    profile_.timed("gather_forces", vertices.count,
                   std::int64_t(gather_bytes(state_)) * vertices.count / state_.size.vertex_count,
                   [&] { gather_forces(state_); });
}

void ActiveTerms::evaluate_stiffness(bool projected, double dissipative_scale)
{
    const TraceScope scope("stiffness");
    const auto add = [&](const Term* term) {
        timed(*term, std::string(term->name) + "_stiffness", traffic_.at(term).stiffness,
              [&] { term->add_stiffness(state_, params_, projected); });
    };
    clear_stiffness(state_);
    if (dissipative_scale > 0 && !dissipative_.empty()) {
        for (const Term* term : dissipative_) add(term);
        // Dissipative terms act on vertices only.
        scale_blocks(state_.vertex_stiffness, block_real(dissipative_scale), items_of(state_, ItemKind::vertex));
    }
    for (const Term* term : conservative_) add(term);
    add_pair_diagonals(state_);
}

void ActiveTerms::evaluate_drag()
{
    clear_stiffness(state_);
    for (const Term* term : dissipative_) term->add_stiffness(state_, params_, false);
}

double ActiveTerms::second_order_stretch(const std::vector<real>& direction)
{
    const double scale = params_.membrane.scale + params_.curved_membrane.scale;  // at most one of them acts
    if (scale == 0) return 0;
    clear_forces(state_);
    const bool curved = params_.curved_membrane.scale > 0;
    const double energy = launch_sum<curve_way>(
        items_of(state_, ItemKind::face),
        curve_way_args{state_.size, state_.pos.data(), direction.data(), state_.face_vertex.data(),
                       state_.face_material.data(), state_.face_area.data(), state_.face_weights.data(),
                       state_.material_stretch.data(), curved ? state_.material_curve.data() : nullptr,
                       state_.face_force.data(), scale});
    gather_forces(state_);
    return energy;
}

double ActiveTerms::energy()
{
    const TraceScope scope("energy");
    double total = 0;
    for (const Term* term : conservative_)
        total += timed(*term, term->name, traffic_.at(term).value, [&] { return term->energy(state_, params_); });
    return total;
}

void ActiveTerms::conservative_force(std::vector<real>& force) const
{
    std::swap(state_.force, force);
    sum_forces(false);
    std::swap(state_.force, force);
}

double ActiveTerms::potential_energy() const
{
    double total = 0;
    for (const Term* term : conservative_)
        if (term->family != EnergyFamily::air)
            total += term->energy_over(state_, params_, all_items_of(state_, term->per));
    return total;
}

double ActiveTerms::dissipation() const
{
    double total = 0;
    for (const Term* term : dissipative_) total += term->energy(state_, params_);
    return total;
}

double ActiveTerms::kinetic_energy() const { return 0.5 * mass_square(state_, state_.vel); }

double ActiveTerms::energy_of(EnergyFamily family) const
{
    double total = 0;
    for (const Term* term : conservative_)
        if (term->family == family) total += term->energy_over(state_, params_, all_items_of(state_, term->per));
    return total;
}

}  // namespace selvage
