#pragma once
#include <functional>
#include <vector>

#include "host/solver/linear/linear_solver.hpp"
#include "host/solver/stepping/direction_limits.hpp"
#include "host/solver/stepping/system.hpp"

namespace selvage {

struct NewtonOptions {
    int max_iterations = 12;
    double tolerance = 1e-2;        ///< Norm of the objective's gradient over the system's force scale [1].
    double velocity_tolerance = 0;  ///< A step has also converged when an iteration wants to move no vertex faster
                                    ///< than this [m/s].
    /// Above 0: the step is to be solved. It has converged when the acceleration that is left to find is below this, as
    /// root mean square over the free mass [m/s^2]. Linear solves then end by their error in
    /// the energy norm, and the expected place is where the step starts from.
    double acceleration_left = 0;
    double linear_tolerance = 0.05;  ///< Relative residual of the linear solves [1], where the step need not be solved.
    bool towards_rest = false;       ///< Motion is to die down: integrators leave out what takes their damping off.
    MoveLimits move_limits;          ///< Of one iteration.
    bool full_stiffness = false;     ///< Exact second derivatives instead of the projected ones.
    const std::function<bool()>* stop = nullptr;  ///< Asked before each iteration: true breaks off.
};

struct NewtonReport {
    bool converged = false;         ///< A tolerance was met.
    bool stuck = false;             ///< No step along the direction lowered the objective.
    bool broken_off = false;        ///< As asked: the state is that of an unfinished step.
    bool almost_converged = false;  ///< Stuck where hardly anything was left to gain.
    int iterations = 0;
    int linear_iterations = 0;
    int negative_curvature = 0;    ///< Iterations whose linear solve met negative curvature.
    int indefinite = 0;            ///< Iterations whose linear solve met it before its first step.
    double residual = 0;           ///< Gradient norm over the force scale, at the end [1].
    double acceleration_left = 0;  ///< About what the last direction had still to find, or a bound of it [m/s^2].
    int bent = 0;                  ///< Iterations whose way was bent, each by one more linear solve.
};

/// Minimises the objective of an implicit step, or the static energy, by Newton's method with a line search:
///     Phi(x) = sum_i m_i |x_i - target_i|^2 / (2 h^2) + E(x) + h R((x - origin) / h)
/// With velocity v = (x - origin) / h its stationary point solves m (x - target) / h^2 = f(x, v). Implicit Euler is
/// h = dt, origin = x_n, target = x_n + dt v_n: the step of Baraff and Witkin 1998, solved to the end instead of once
/// linearised. Source: Martin and others 2011, eq. 7; Gast and others 2015 for the line search.
class Newton {
public:
    /// The references must outlive this object.
    Newton(System& system, LinearSolver& linear) : system_(system), linear_(linear) {}

    System& system() { return system_; }

    /// Moves the state to the minimum, pos there and vel to (x - origin) / span; friction anchors stay as they are.
    /// @param span      h of the objective [s], > 0
    /// @param origin    planes like pos [m]; at pinned vertices it must equal pos, as must target and expected
    /// @param expected  where the minimum may be; null: unknown
    NewtonReport minimise(double span, const std::vector<real>& origin, const std::vector<real>& target,
                          const NewtonOptions& options, const std::vector<real>* expected = nullptr);
    /// Iterations on the static energy; the velocities become zero, friction anchors settle before each.
    NewtonReport relax(const NewtonOptions& options);

    /// Fields of a minimisation, planes like pos. They are kept to be filled again; nothing else is.
    struct Vectors {
        std::vector<real> start, base, downhill, direction, unlimited, straight, curve;
    };

private:
    System& system_;
    LinearSolver& linear_;
    Vectors vectors_;
};

/// One step of implicit Euler, with friction settled at its end. @param dt  [s], > 0
/// @param free_flight  receives where the vertices would be without forces, planes like pos [m]; null: nobody asks
/// @param expected     see Newton::minimise
NewtonReport implicit_euler_step(Newton& newton, double dt, const NewtonOptions& options,
                                 std::vector<real>* free_flight = nullptr, const std::vector<real>* expected = nullptr);

}  // namespace selvage
