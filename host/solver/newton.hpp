#pragma once
#include <vector>

#include "host/solver/body_contact.hpp"
#include "host/solver/linear_solver.hpp"
#include "host/solver/params.hpp"
#include "host/solver/profile.hpp"
#include "host/solver/state.hpp"
#include "host/solver/terms.hpp"

namespace selvage {

struct NewtonOptions {
    int max_iterations = 12;
    double tolerance = 1e-2;           ///< Norm of the objective's gradient over the force scale [1].
    double still = 0;                  ///< A step is also done when an iteration moves no vertex faster than this [m/s].
    double linear_tolerance = 0.05;    ///< Relative residual of the linear solves [1].
    double max_move = 0.02;            ///< Largest way of a vertex near a body in one iteration [m].
    double max_far_move = 0.1;         ///< Largest way of a vertex that is not near one, if there are bodies [m].
    bool full_stiffness = false;       ///< Exact second derivatives instead of the projected ones.
};

struct NewtonReport {
    bool converged = false;            ///< The tolerance was met.
    bool stuck = false;                ///< No step along the direction lowered the objective.
    int iterations = 0;
    int linear_iterations = 0;
    double residual = 0;               ///< Gradient norm over the force scale, at the end [1].
};

/// Minimises the objective of an implicit Euler step, or the static energy, by Newton's method with a line search:
///     Phi(x) = sum_i m_i |x_i - x^_i|^2 / (2 dt^2) + E(x) + dt R((x - x_n) / dt),   x^ = x_n + dt v_n
/// whose stationary point is the step of D11 solved to the end instead of once linearised.
/// Source: Martin and others 2011, eq. 7; Gast and others 2015 for the line search.
class Newton {
public:
    /// @param contact may be null: no bodies. All references must outlive this object.
    Newton(State& state, const Params& params, LinearSolver& linear, ContactField* contact, Profile& profile);

    /// One implicit Euler step: state.pos and state.vel move from t to t + dt. @param dt [s], > 0
    NewtonReport step(double dt, const NewtonOptions& options);
    /// Iterations on the static energy; state.vel becomes zero, friction settles after each.
    NewtonReport relax(const NewtonOptions& options);

    /// Norm of the net conservative force on free vertices over that of gravity (or of `force_scale` if larger) [1].
    double static_residual();
    double force_scale() const { return force_scale_; }   ///< [N]

    double energy_of(std::string_view term) const;   ///< Energy of one term at the present state [J]; 0 if inactive.
    double potential_energy() const;                 ///< Of all conservative terms [J].
    double kinetic_energy() const;                   ///< [J]

private:
    double objective();
    void evaluate_gradient();
    void assemble(bool projected);
    double gradient_norm() const;
    double search_direction(const NewtonOptions& options, NewtonReport& report);
    bool search_line(double slope, const NewtonOptions& options);
    double largest_move() const;
    double longest_fraction(const NewtonOptions& options) const;
    void place(double fraction);
    void keep_outside_bodies();
    void guess_step(const NewtonOptions& options);
    NewtonReport iterate(const NewtonOptions& options, bool settle_each);

    State& state_;
    const Params& params_;
    LinearSolver& linear_;
    ContactField* contact_;
    Profile& profile_;
    std::vector<const Term*> conservative_, dissipative_;
    double force_scale_ = 0;
    double inertia_ = 0;   ///< 1/dt^2; 0 for the static energy [1/s^2].
    double dt_ = 0;
    std::vector<real> start_, target_, base_, downhill_, direction_;
};

}  // namespace selvage
