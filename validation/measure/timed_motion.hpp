#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/collision/body_query.hpp"
#include "host/scene/run_settings.hpp"
#include "host/scene/scene_model.hpp"
#include "host/solver/stepping/equilibrium.hpp"

namespace selvage {

/// One accepted step of a timed motion.
struct MotionStep {
    double time = 0, dt = 0;  ///< At its end, and its length [s].
    int iterations = 0;       ///< Of Newton's method.
    double left = -1;         ///< See StepEvent.
    bool solved = true;       ///< Likewise.
    bool divided = false;     ///< It is shorter than solver.step and the frames ask for.
    Vec3 center;              ///< Center of mass of all vertices, those held included [m].
    /// How far the accepted places are from the solution of the same step, as an acceleration over gravity: root mean
    /// square over the free mass [1]; -1: not asked.
    double missed = -1;
};

/// The motion of a scene until its solver.until, computed as a run computes it: with its model, its settings and its
/// driver, but without files.
class TimedMotion {
public:
    /// @param scene  TOML text of a scene
    explicit TimedMotion(const std::string& scene);

    /// Has the cloth start elsewhere, at rest. Level sheets of a scene start with a ripple, which strains them a
    /// little.
    /// @param place  of coordinates in the panel [m]
    void start_at(const std::function<Vec3(const Vec2& coordinates)>& place);
    /// Gives the cloth velocities to start with. @param velocity  of a place [m/s]
    void start_with(const std::function<Vec3(const Vec3& place)>& velocity);
    /// Has each step solved once more from where it started, to the end: see MotionStep::missed.
    void solve_again() { solves_again_ = true; }

    /// Moves the cloth.
    /// @param go_on  asked after each step; false ends the motion
    /// @throws StepFailureError where no step succeeds
    std::vector<MotionStep> run(const std::function<bool(const MotionStep&)>& go_on = {});

    const RunSettings& settings() const { return settings_; }
    Phase& phase() { return *phase_; }
    const Phase& phase() const { return *phase_; }
    Vec3 center() const;
    /// Integral of the squared distance from a line along y over that of the distance itself: the length of the simple
    /// pendulum that swings about it as fast [m]. @param axis  a point of the line [m]
    double pendulum_length(const Vec3& axis) const;
    Vec3 angular_momentum() const;  ///< About the center of mass [kg m^2/s].
    double kinetic_energy() const { return phase_->system().kinetic_energy(); }  ///< [J]

private:
    MotionStep step_of(const StepEvent& event);
    double missed(const StepEvent& event);
    void return_to(const SolverSnapshot& place, double time);

    SceneModel model_;
    RunSettings settings_;
    std::optional<BodyQuery> query_;
    Profile profile_;
    std::unique_ptr<Phase> phase_;
    std::unique_ptr<Integrator> integrator_;
    bool solves_again_ = false;
    SolverSnapshot before_, after_;
};

/// Returns the largest `missed` and the worst excess of `missed` over `left` of steps that were solved again.
struct MissedSteps {
    double worst = 0;        ///< Largest `missed` [1].
    double over_bound = -1;  ///< Largest of `missed` less `left` [1].
};
MissedSteps missed_steps(const std::vector<MotionStep>& steps);

}  // namespace selvage
