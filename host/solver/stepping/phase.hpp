#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "host/model/cloth_model.hpp"
#include "host/solver/linear/linear_solver.hpp"
#include "host/solver/state/rest_state.hpp"
#include "host/solver/state/topology.hpp"
#include "host/solver/stepping/newton.hpp"
#include "host/solver/stepping/system.hpp"

namespace selvage {

struct PhaseOptions {
    Params params;
    bool joined = true;        ///< Sewn vertices are one particle.
    std::vector<char> welded;  ///< Where they are not: those that are all the same; see make_topology.
    bool float_solves = false;
    LinearOptions linear;
    double contact_margin = 0.03;  ///< See ClothBodyContact [m].
    /// Contact is as stiff as each place asks; the terms' stiffness is that of the heaviest fabric where no body is
    /// fast. False: it is that of all places.
    bool local_stiffness = false;
    std::optional<Air> air;  ///< See Surroundings.
};

/// Interpolations between the particles of a model's cloths, finest first. @param finest  of model.cloth
ParticleProlongations particle_prolongations(const ClothModel& model, const Topology& finest,
                                             const PhaseOptions& options);

/// One phase of a run, sewing or draping: a cloth's particles as a system, and what solves its steps.
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

    System& system() { return system_; }
    const System& system() const { return system_; }
    State& state() { return system_.state(); }
    const State& state() const { return system_.state(); }
    Params& params() { return system_.params(); }
    const Params& params() const { return system_.params(); }
    ClothBodyContact* contact() { return system_.body_contact(); }
    const ClothBodyContact* contact() const { return system_.body_contact(); }
    ClothContact* cloth_contact() { return system_.cloth_contact(); }
    const ClothContact* cloth_contact() const { return system_.cloth_contact(); }
    const Topology& topology() const { return topology_; }
    LinearSolver& linear() { return *linear_; }
    Newton& newton() { return newton_; }
    double edge_length() const { return edge_length_; }  ///< Of a typical edge at rest [m].

    std::vector<Vec3> positions() const { return cloth_vectors(topology_, state().size, state().pos); }
    std::vector<Vec3> velocities() const { return cloth_vectors(topology_, state().size, state().vel); }
    std::size_t bytes() const { return state().bytes() + linear_->bytes(); }

private:
    Topology topology_;
    double edge_length_;
    System system_;
    std::unique_ptr<LinearSolver> linear_;
    Newton newton_;
};

}  // namespace selvage
