#pragma once
#include <functional>
#include <vector>

#include "host/solver/contact/body_contact.hpp"
#include "host/solver/contact/cloth_contact.hpp"
#include "host/solver/linear/linear_solver.hpp"
#include "host/solver/terms/active_terms.hpp"
#include "host/solver/terms/params.hpp"

namespace selvage {

struct NewtonOptions {
    int max_iterations = 12;
    double tolerance = 1e-2;         ///< Norm of the objective's gradient over the force scale [1].
    double still = 0;                ///< A step is also done when an iteration moves no vertex faster than this [m/s].
    double decrement = 0;            ///< A step is also done when an iteration promises less than this part of the
                                     ///< kinetic energy [1].
    double most_left = 1e300;        ///< But not while an iteration wants to move a vertex further than this [m].
    double linear_tolerance = 0.05;  ///< Relative residual of the linear solves [1].
    double max_move = 0.02;          ///< Largest way of a vertex near a body in one iteration [m].
    double max_far_move = 0.1;       ///< Largest way of a vertex that is not near one, if there are bodies [m].
    bool full_stiffness = false;     ///< Exact second derivatives instead of the projected ones.
    const std::function<bool()>* stop = nullptr;  ///< Asked before each iteration: true breaks off.
};

struct NewtonReport {
    bool converged = false;   ///< The tolerance was met.
    bool stuck = false;       ///< No step along the direction lowered the objective.
    bool broken_off = false;  ///< As asked: the state is that of an unfinished step.
    bool nearly = false;      ///< Stuck where hardly anything was left to gain.
    int iterations = 0;
    int linear_iterations = 0;
    int negative = 0;     ///< Iterations whose linear solve met negative curvature.
    int blind = 0;        ///< Iterations whose linear solve met negative curvature before its first step.
    double residual = 0;  ///< Gradient norm over the force scale, at the end [1].
};

/// Minimises the objective of an implicit step, or the static energy, by Newton's method with a line search:
///     Phi(x) = sum_i m_i |x_i - target_i|^2 / (2 h^2) + E(x) + h R((x - origin) / h)
/// With velocity v = (x - origin) / h its stationary point solves m (x - target) / h^2 = f(x, v). Implicit Euler is
/// h = dt, origin = x_n, target = x_n + dt v_n: the step of D11 solved to the end instead of once linearised.
/// Source: Martin and others 2011, eq. 7; Gast and others 2015 for the line search.
class Newton {
public:
    /// @param contact  may be null: no bodies
    /// @param cloth    may be null: the cloth passes through itself. All references must outlive this object.
    Newton(State& state, const Params& params, LinearSolver& linear, ContactField* contact, ClothContact* cloth,
           Profile& profile);

    /// Moves state.pos to the minimum and state.vel to (x - origin) / span; anchors stay as they are.
    /// @param span    h of the objective [s], > 0
    /// @param origin  planes like pos [m]; at pinned vertices it must equal pos, as must target and expected
    /// @param expected  where the minimum may be; null: unknown
    NewtonReport minimise(double span, const std::vector<real>& origin, const std::vector<real>& target,
                          const NewtonOptions& options, const std::vector<real>* expected = nullptr);
    /// One implicit Euler step: state.pos and state.vel move from t to t + dt. @param dt [s], > 0
    NewtonReport step(double dt, const NewtonOptions& options);
    /// Ends a step for all that slips: anchors on bodies, in hinges and between cloth and cloth.
    void settle();
    /// Iterations on the static energy; state.vel becomes zero, anchors settle after each.
    NewtonReport relax(const NewtonOptions& options);

    /// Lists the pairs of cloth in contact: whoever evaluates forces elsewhere than on a way of Newton's must ask for
    /// it.
    void list_pairs();

    /// Norm of the net conservative force on free vertices over that of gravity (or of `force_scale` if larger) [1].
    /// Those asleep count with what it was when they fell asleep.
    double static_residual();
    double force_scale() const { return force_scale_; }  ///< [N]

    const std::vector<real>& downhill() const
    {
        return downhill_;
    }  ///< The last gradient, downhill, planes like pos [N].

    ActiveTerms& terms() { return terms_; }
    const ActiveTerms& terms() const { return terms_; }
    double energy_of(std::string_view term) const { return terms_.energy_of(term); }  ///< [J]; 0 if inactive.
    double potential_energy() const { return terms_.potential_energy(); }             ///< [J]
    double kinetic_energy() const { return terms_.kinetic_energy(); }                 ///< [J]

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
    void follow_pins(std::vector<real>& move);
    bool advance_held();
    void clear_way(bool uniform);
    void take_free_direction();
    void scale_direction(double by);
    void scale_to_longest(const NewtonOptions& options);
    void guess_step(const NewtonOptions& options, const std::vector<real>* expected);
    NewtonReport iterate(const NewtonOptions& options, bool settle_each);

    State& state_;
    const Params& params_;
    LinearSolver& linear_;
    ContactField* contact_;
    ClothContact* cloth_;
    Profile& profile_;
    ActiveTerms terms_;
    double force_scale_ = 0;
    double promised_ = 0, wanted_move_ = 0;  ///< Of the last direction, before anything stood in its way [J], [m].
    double inertia_ = 0;                     ///< 1/h^2; 0 for the static energy [1/s^2].
    double span_ = 0;                        ///< h [s]
    bool assembled_ = false;                 ///< The linear solver has a matrix of this step.
    std::vector<real> start_, origin_, target_, base_, downhill_, direction_, free_direction_;
};

}  // namespace selvage
