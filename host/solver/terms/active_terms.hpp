#pragma once
#include <map>
#include <string_view>
#include <vector>

#include "host/parallel/profile.hpp"
#include "host/solver/state/state.hpp"
#include "host/solver/terms/params.hpp"
#include "host/solver/terms/terms.hpp"

namespace selvage {

/// The terms that are active in a phase, evaluated together at the present state: what every integrator is made of.
class ActiveTerms {
public:
    /// All references must outlive this object; which terms are active is decided here.
    ActiveTerms(State& state, const Params& params, Profile& profile);

    /// Writes the net force of all terms to state.force [N]. @param dissipative  with those that depend on velocity
    void evaluate_forces(bool dissipative) { sum_forces(dissipative); }
    /// Writes the stiffness of all terms to the element slots [N/m].
    /// @param dissipative_scale  times d2R/dv2 is added for the dissipative terms [1/s]; 0: without them
    void evaluate_stiffness(bool projected, double dissipative_scale);
    /// Writes d2R/dv2 of the dissipative terms alone to state.vertex_stiffness [kg/s].
    void evaluate_drag();

    /// Of all conservative terms [J], of what is awake; counted in the profile.
    double energy();
    double dissipation() const;  ///< R of all dissipative terms, of what is awake [W].
    bool dissipates() const { return !dissipative_.empty(); }

    /// Writes to state.force the force of the stretch of second order along a direction, planes like pos, on what is
    /// awake [N]; see kernels/curve_way.h.
    /// @returns the energy of that stretch alone [J]; 0 where no membrane acts
    double second_order_stretch(const std::vector<real>& direction);

    // Queries. They write nothing to the state but what stages derive from its positions and the elements' slots, both
    // of which every evaluation fills before it reads them.

    /// Writes the net force of the conservative terms on what is awake [N]; state.force stays as it is.
    /// @param force  planes like pos
    void conservative_force(std::vector<real>& force) const;
    double potential_energy() const;  ///< Of the whole cloth without what the air does, outside the profile [J].
    double energy_of(EnergyFamily family) const;  ///< Likewise, of the terms of one family [J].
    double kinetic_energy() const;                ///< [J]

private:
    template <class Work>
    auto timed(const Term& term, std::string_view name, std::int64_t bytes, const Work& work) const;
    void sum_forces(bool dissipative) const;

    State& state_;
    const Params& params_;
    Profile& profile_;

    struct Traffic {
        std::int64_t value, force, stiffness;  ///< [bytes]
    };
    std::vector<const Term*> conservative_, dissipative_;
    std::map<const Term*, Traffic> traffic_;
};

}  // namespace selvage
