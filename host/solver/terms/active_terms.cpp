#include "host/solver/terms/active_terms.hpp"

#include "host/parallel/launch.hpp"
#include "host/solver/terms/traffic.hpp"

namespace selvage {
namespace {

// While it exists, what sleeps takes part as well.
class WholeCloth {
public:
    explicit WholeCloth(AwakeItems& awake) : awake_(awake), all_(awake.all) { awake_.all = true; }
    ~WholeCloth() { awake_.all = all_; }
    WholeCloth(const WholeCloth&) = delete;
    WholeCloth& operator=(const WholeCloth&) = delete;

private:
    AwakeItems& awake_;
    bool all_;
};

}  // namespace

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
auto ActiveTerms::timed(const Term& term, std::string_view name, std::int64_t bytes, const Work& work)
{
    const int whole = term.item_count(state_.size), items = items_of(state_, term.per).count;
    return profile_.timed(name, items, items == whole ? bytes : bytes * items / whole, work);
}

void ActiveTerms::evaluate_forces(bool dissipative)
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
        for_each_item(items_of(state_, ItemKind::vertex),
                      [k = state_.vertex_stiffness.data(), scale = block_real(dissipative_scale)](int v) {
                          for (int i = 9 * v; i < 9 * v + 9; ++i) k[i] *= scale;
                      });
    }
    for (const Term* term : conservative_) add(term);
    add_pair_diagonals(state_);
}

void ActiveTerms::evaluate_drag()
{
    clear_stiffness(state_);
    for (const Term* term : dissipative_) term->add_stiffness(state_, params_, false);
}

double ActiveTerms::energy()
{
    const TraceScope scope("energy");
    double total = 0;
    for (const Term* term : conservative_)
        total += timed(*term, term->name, traffic_.at(term).value, [&] { return term->energy(state_, params_); });
    return total;
}

double ActiveTerms::potential_energy() const
{
    const WholeCloth whole(state_.awake);
    double total = 0;
    for (const Term* term : conservative_) total += term->energy(state_, params_);
    return total;
}

double ActiveTerms::dissipation() const
{
    double total = 0;
    for (const Term* term : dissipative_) total += term->energy(state_, params_);
    return total;
}

double ActiveTerms::kinetic_energy() const
{
    const int vs = state_.size.vertex_stride;
    return 0.5 * sum_items(state_.size.vertex_count, [this, vs](int v) {
               double squared = 0;
               for (int c = 0; c < 3; ++c) squared += state_.vel[c * vs + v] * state_.vel[c * vs + v];
               return state_.inv_mass[v] == 0 ? 0.0 : state_.mass[v] * squared;
           });
}

double ActiveTerms::energy_of(std::string_view name) const
{
    const WholeCloth whole(state_.awake);
    for (const Term* term : conservative_)
        if (term->name == name) return term->energy(state_, params_);
    return 0;
}

}  // namespace selvage
