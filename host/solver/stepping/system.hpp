#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "host/model/air.hpp"
#include "host/solver/contact/cloth_body_contact.hpp"
#include "host/solver/contact/cloth_contact.hpp"
#include "host/solver/contact/pin_paths.hpp"
#include "host/solver/state/clock.hpp"
#include "host/solver/terms/active_terms.hpp"
#include "host/solver/terms/velocity_filters.hpp"

namespace selvage {

/// What a cloth meets and how what holds it moves. What is missing is null.
struct Surroundings {
    std::shared_ptr<ClothBodyContact> bodies = nullptr;  ///< Contact of vertices with bodies.
    /// Contact of the cloth with itself, and of edges and faces with bodies.
    std::unique_ptr<ClothContact> cloth = nullptr;
    std::optional<PinPaths> pins = std::nullopt;
    double contact_margin = 0.03;  ///< See ClothBodyContact [m].
    /// What moves the air; without it the air moves as the parameters of its terms say.
    std::optional<Air> air = std::nullopt;
};

/// The mechanical system that integrators move: the cloth's state with the forces, contacts, velocity filters and
/// prescribed motions that act on it, and its one clock. It says what acts; how the state moves is left to the
/// integrators.
class System {
public:
    /// @param params   decide which terms and velocity filters act   @param profile  must outlive this object
    System(State state, const Params& params, Profile& profile, Surroundings surroundings = {});
    System(const System&) = delete;
    System& operator=(const System&) = delete;

    State& state() { return state_; }
    const State& state() const { return state_; }
    Params& params() { return params_; }
    const Params& params() const { return params_; }
    Clock& clock() { return clock_; }
    const Clock& clock() const { return clock_; }
    Profile& profile() { return profile_; }
    ClothBodyContact* body_contact() { return around_.bodies.get(); }
    const ClothBodyContact* body_contact() const { return around_.bodies.get(); }
    ClothContact* cloth_contact() { return around_.cloth.get(); }
    const ClothContact* cloth_contact() const { return around_.cloth.get(); }
    /// Bodies act by forces, whose contact planes limit how far a step may go; false as well where a velocity filter
    /// stands for contact.
    bool bodies_exert_forces() const { return bodies_exert_forces_; }

    // Evaluation: the results stand in the state. Contacts are those found last; see refresh_planes and refresh_pairs.

    /// Writes the net force to state.force [N]. @param dissipative  with the terms that depend on velocity
    void evaluate_forces(bool dissipative) { terms_.evaluate_forces(dissipative); }
    /// Writes the stiffness to the elements' slots; see ActiveTerms.
    void evaluate_stiffness(bool projected, double dissipative_scale)
    {
        terms_.evaluate_stiffness(projected, dissipative_scale);
    }
    /// Writes d2R/dv2 to state.vertex_stiffness [kg/s].
    void evaluate_drag() { terms_.evaluate_drag(); }
    /// See ActiveTerms.
    double second_order_stretch(const std::vector<real>& direction) { return terms_.second_order_stretch(direction); }
    bool dissipates() const { return terms_.dissipates(); }
    /// Air that moves, and may so feed the cloth with energy; air that is still only takes it.
    bool wind_blows() const { return params_.wind.normal > 0 || params_.wind.tangential > 0; }
    /// Of all conservative terms on what is awake [J]; counted in the profile.
    double awake_energy() { return terms_.energy(); }
    double dissipation() const { return terms_.dissipation(); }  ///< R of what is awake [W].

    // Queries: whoever asks them finds the state, the next step included, as if it had not asked.

    /// Net conservative force on what is free and awake [N], planes like pos; 0 elsewhere. Valid until the next query.
    const std::vector<real>& static_force() const;
    /// Norm of the net conservative force on free vertices over that of gravity (of earth's, if there is none) [1].
    /// Those asleep count with what it was when they fell asleep.
    double residual() const { return residual_of(static_force()); }
    double residual_of(const std::vector<real>& static_force) const;  ///< The same of a force that is known already.
    double force_scale() const { return force_scale_; }               ///< What forces are measured against [N].
    double gravity_scale() const { return gravity_scale_; }           ///< Gravity, or earth's if there is none [m/s^2].
    double kinetic_energy() const { return terms_.kinetic_energy(); }                 ///< [J]
    double potential_energy() const { return terms_.potential_energy(); }             ///< See ActiveTerms [J].
    double energy_of(EnergyFamily family) const { return terms_.energy_of(family); }  ///< Of the whole cloth [J].
    Energies energies() const;

    // Contacts.

    /// Finds contacts, intersections and cloth inside bodies afresh: where the state has been set from outside.
    void find_contacts();
    /// Lets cloth that lies on a body be held by friction from its first step on.
    void hold_by_friction();
    /// Finds the contact planes of the bodies at state.pos.
    void refresh_planes();
    /// Finds how the air at the end of the clock's step streams past the faces at state.pos.
    void refresh_air();
    /// Lists the pairs of cloth in contact at state.pos. Moves that limit_by_pairs has passed have theirs listed.
    void refresh_pairs();
    /// Forgets what contact searches of earlier steps have found, so that a step depends on the state alone.
    void forget_searches();
    /// Shortens a move of the cloth until nothing is passed through on its straight way, and lists the pairs that are
    /// in contact on it; see ClothContact::filter_step. Without contact of cloth nothing happens.
    void limit_by_pairs(std::vector<real>& move, bool uniform);
    /// Ends a step for friction and hysteresis: what slips lets its anchors follow, limits follow the normal forces.
    /// The air finds the cloth where it is.
    void settle();
    bool has_velocity_filters() const { return !velocity_filters_.empty(); }
    /// Ends a step of dt [s] with the velocity filters that are active. @returns true if one may have changed the state
    bool apply_velocity_filters(double dt);

    // Bodies and held vertices, whose motion is prescribed: the boundary.

    double motion_end() const;  ///< Time after which they stand still [s]; 0 if none moves.
    /// The longest part of `room` from the clock's time on in which they move no further than a step may [s].
    double longest_step(double room) const;
    /// Puts the bodies where they are at the clock's time; held vertices are where the state says.
    void place_boundary();
    /// Moves them to the end of the clock's step, or, where cloth may be in their way, sets that as their goal.
    void move_boundary();
    /// They have not reached their goal.
    bool boundary_waits() const { return around_.cloth && around_.cloth->boundary_is_pending(); }
    /// Moves them towards their goal as far as the cloth makes way; see MovingBoundary.
    /// @returns true if they are not there yet
    bool advance_boundary(const MovingBoundary::Follow& follow);

private:
    template <class Work>
    void timed_contact(std::string_view name, const Work& work);

    State state_;
    Params params_;
    Profile& profile_;
    Surroundings around_;
    bool bodies_exert_forces_;
    ActiveTerms terms_;
    std::vector<const VelocityFilter*> velocity_filters_;
    double gravity_scale_, force_scale_;
    Clock clock_;
    mutable std::vector<real> static_force_;  ///< The result of the query of that name; nothing else depends on it.
};

}  // namespace selvage
