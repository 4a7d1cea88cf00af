#pragma once
#include <memory>
#include <vector>

#include "host/model/cloth_model.hpp"
#include "host/solver/contact/fabric_contact.hpp"
#include "host/solver/contact/pin_paths.hpp"
#include "host/solver/linear/linear_solver.hpp"
#include "host/solver/state/rest_state.hpp"
#include "host/solver/state/topology.hpp"
#include "host/solver/stepping/newton.hpp"
#include "host/solver/terms/rules.hpp"

namespace selvage {

struct PhaseOptions {
    Params params;
    bool joined = true;  ///< Sewn vertices are one particle.
    bool float_solves = false;
    LinearOptions linear;
    double contact_margin = 0.03;  ///< See FabricContact [m].
};

/// One phase of a run, sewing or draping: its particles, its terms and its solver.
class Phase {
public:
    /// @param query        null when the phase has no contact with bodies
    /// @param positions    per cloth vertex [m]
    /// @param velocities   per cloth vertex [m/s]; empty: at rest
    Phase(const ClothModel& model, const PhaseOptions& options, BodyQuery* query, Profile& profile,
          const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities);

    /// Begins again at other positions, at rest, as if it had been made with them.
    /// @param model  that it was made of   @param positions  per cloth vertex [m]
    void start_over(const ClothModel& model, const std::vector<Vec3>& positions);

    State& state() { return state_; }
    const State& state() const { return state_; }
    const Topology& topology() const { return topology_; }
    Params& params() { return options_.params; }
    const Params& params() const { return options_.params; }
    Newton& newton() { return *newton_; }
    const Newton& newton() const { return *newton_; }
    LinearSolver& linear() { return *linear_; }
    ContactField* contact() { return contact_.get(); }
    const ContactField* contact() const { return contact_.get(); }
    ClothContact* cloth_contact() { return cloth_contact_.get(); }
    const ClothContact* cloth_contact() const { return cloth_contact_.get(); }
    /// Looks for contacts, intersections and cloth inside bodies afresh: where the state has been set from outside.
    void look_around();
    double edge_length() const { return edge_length_; }  ///< Of a typical edge at rest [m].
    double motion_end() const;  ///< Time after which bodies and pins stand still [s]; 0 if none moves.
    /// The longest part of `room`, from a time on, in which bodies and pins move no further than a step may.
    double longest_step(double time, double room) const;
    /// Puts the bodies where they are at a time; pinned vertices are where the state says.
    void place(double time);
    /// Moves bodies and pinned vertices to a time; see FabricContact::move_to.
    void move_to(double time);

    bool has_rules() const { return !rules_.empty(); }
    /// Ends a step of dt [s] with the rules that are active. @returns true if one may have changed the state
    bool apply_rules(double dt);

    std::vector<Vec3> positions() const { return cloth_vectors(topology_, state_.size, state_.pos); }
    std::vector<Vec3> velocities() const { return cloth_vectors(topology_, state_.size, state_.vel); }
    std::size_t bytes() const { return state_.bytes() + linear_->bytes(); }

private:
    void take_hold();

    PhaseOptions options_;
    Profile& profile_;
    std::vector<const Rule*> rules_;
    Topology topology_;
    State state_;
    PinPaths pins_;
    double edge_length_;
    std::unique_ptr<LinearSolver> linear_;
    std::unique_ptr<FabricContact> contact_;
    std::unique_ptr<ClothContact> cloth_contact_;
    std::unique_ptr<Newton> newton_;
};

}  // namespace selvage
