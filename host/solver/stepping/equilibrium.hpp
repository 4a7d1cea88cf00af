#pragma once
#include "host/solver/stepping/step_control.hpp"

namespace selvage {

struct EquilibriumOptions {
    StepOptions step;
    Integrator* integrator = nullptr;  ///< What moves the cloth; null: implicit Euler.
    bool hurries = true;      ///< Long steps of implicit Euler that are not solved to the end: from the start with an
                              ///< integrator of first order, with one of second once the forces first nearly balance.
    double tolerance = 1e-3;  ///< Relative static force residual to reach [1].
    double max_time = 30;     ///< Simulated time after which to give up [s].
    int newton_iterations = 12;
    std::function<bool()> stop;  ///< Asked within steps: true gives up the one at hand and stops.
    bool sleeps = true;          ///< What hardly moves is left alone for some steps; see sleep.hpp.
    bool only_balances = false;  ///< Ends where the forces first nearly balance: a finer cloth goes on from there.
    int load_steps = 1;          ///< The weight grows to its whole in so many steps, with rest after each.
};

/// Where a drape stands; kept in checkpoints.
struct DrapeProgress {
    double time = 0;               ///< [s]
    double switch_residual = 0.5;  ///< Below it the static energy is minimised; lowered when that came too early.
    int hold = 0;                  ///< Steps to take before the next attempt.
    double residual = 1e30;        ///< Static residual after the last step [1].
    double dt = 0;                 ///< Of the next step; 0: the longest [s].
    int load = 0;                  ///< Load steps that are done.
    int asleep = 0;                ///< Steps for which parts of the cloth will sleep.
};

/// Lets the cloth fall with implicit steps, in the end dissipative ones (see EquilibriumOptions::hurries), and finishes
/// with Newton's method on the static energy as soon as the forces are nearly balanced. With several load steps it is
/// let down slowly: what falls at once may be caught in folds that a drape meter, which lowers its specimen, does not
/// see.
PhaseEnd drape_to_equilibrium(Phase& phase, const EquilibriumOptions& options, DrapeProgress& progress,
                              const AfterStep& after_step);

/// Moves the cloth accurately through time up to `until` [s]: every step's Newton iterations reach their tolerance.
PhaseEnd drape_until(Phase& phase, const EquilibriumOptions& options, double until, double frame_interval,
                     DrapeProgress& progress, const AfterStep& after_step);

}  // namespace selvage
