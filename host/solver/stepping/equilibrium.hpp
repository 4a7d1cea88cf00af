#pragma once
#include "host/solver/stepping/step_control.hpp"

namespace selvage {

struct EquilibriumOptions {
    StepOptions step;
    Integrator* integrator = nullptr;  ///< What moves the cloth; null: implicit Euler.
    bool hurries = true;      ///< Takes long steps of implicit Euler that are not solved to the end; see RestMode.
    double tolerance = 1e-3;  ///< Relative static force residual to reach [1].
    double max_time = 30;     ///< Simulated time after which to give up [s].
    int newton_iterations = 12;
    std::function<bool()> stop;  ///< Asked within steps: true gives up the one at hand and stops.
    /// Called before a static attempt, and with true where one has been broken off and undone: a resumed run repeats
    /// it.
    std::function<void(bool undone)> attempt = [](bool) {};
    double step_tolerance = 1e-2;  ///< Acceleration that a step of a timed motion may leave to find, over gravity [1].
    bool sleeps = true;            ///< What hardly moves is left alone for some steps; see sleep.hpp.
    bool only_balances = false;    ///< Ends where the forces first nearly balance: a finer cloth goes on from there.
    int load_steps = 1;            ///< The weight grows to its whole in so many steps, with rest after each.
};

/// What the way to rest is steered by. A number that names no source is as it was first written: no measurement of it
/// is on record. `bench scaling -- --scene sphere --until equilibrium` times the way as a whole, and so do the
/// garments.
struct RestTuning {
    // When the static energy is minimised.
    double first_residual = 0.5;  ///< Below it the first attempt is made: the forces half balance.
    double less_residual = 0.5;   ///< Factor of that limit after an attempt that came too early.
    double least_residual = 2;    ///< Times the tolerance: the limit falls no lower.
    int steps_between = 8;        ///< Of motion after an attempt that came too early.
    int stall_limit = 25;   ///< Of motion after which one is made above the limit: forces that creep fall no further.
    double near_rest = 10;  ///< Times the tolerance: cloth that wakes to no more than this only needs to settle.

    // How it is minimised, and when an attempt is given up.
    int chunk = 5;            ///< Newton iterations between two looks at interrupts and limits.
    int chunks = 12;          ///< Of an attempt, at most.
    int patient_chunks = 4;   ///< After so many an attempt must make headway.
    double headway = 0.8;     ///< Factor by which the residual must then stay below the best so far.
    double too_early = 0.05;  ///< Residual above which an attempt on cloth that swings ends after a first chunk that
                              ///< met negative curvature in every iteration: BDF2 leads past such saddles by itself.
    double linear_tolerance = 0.02;  ///< Of the linear solves.

    // How the cloth is moved until then. Lengths are times solver.step.
    double swing_factor = 1.5;    ///< Length of steps while the cloth swings.
    double hurry_factor = 2;      ///< Length of steps while it hurries: only where they lead counts.
    int hurry_iterations = 1;     ///< Newton iterations of such a step.
    int most_iterations = 3;      ///< Newton iterations of a step otherwise.
    double step_tolerance = 0.3;  ///< Tolerance of a step, times that of rest: with a looser one steps near the end
                                  ///< would do nothing.
    double first_load = 0.05;     ///< Part of the weight at the first of several load steps.
};

/// Where a drape stands; kept in checkpoints.
struct DrapeProgress {
    /// Below it the static energy is minimised; lowered when that came too early.
    double switch_residual = RestTuning{}.first_residual;
    int hold = 0;            ///< Steps to take before the next attempt.
    double residual = 1e30;  ///< Static residual after the last step [1].
    StepMemory steps = {};
    int load = 0;    ///< Load steps that are done.
    int asleep = 0;  ///< Steps for which parts of the cloth will sleep.
};

/// How the cloth is moved on its way to rest.
enum class RestMode {
    follow,  ///< With the chosen integrator and its steps, to the end: where the way counts.
    swing,  ///< With the chosen integrator of second order, in longer steps: momentum carries cloth past folds in which
            ///< steps of implicit Euler would creep. Ends at the first static attempt that fails.
    hurry,  ///< With implicit Euler after a swing, else with the chosen integrator of lower order, in yet longer steps
            ///< of one iteration each: only where they lead counts.
};

/// The mode in which a way to rest begins. Friction remembers the way, so load steps ask for one that is followed, and
/// so do explicit schemes and steps that adapt to an error.
RestMode first_mode(const IntegratorInfo& chosen, const EquilibriumOptions& options);

/// The name of the integrator that takes over once the cloth has swung, or an empty one if none does.
std::string_view successor(const IntegratorInfo& chosen, const EquilibriumOptions& options);

/// Moves the cloth (see RestMode), and finishes with Newton's method on the static energy as soon as the forces are
/// nearly balanced. With several load steps it is let down slowly: what falls at once may be caught in folds that a
/// drape meter, which lowers its specimen, does not see.
PhaseEnd drape_to_equilibrium(Phase& phase, const EquilibriumOptions& options, DrapeProgress& progress,
                              const AfterStep& after_step);

/// Moves the cloth accurately through time up to `until` [s]: every step's Newton iterations reach their tolerance.
PhaseEnd drape_until(Phase& phase, const EquilibriumOptions& options, double until, double frame_interval,
                     DrapeProgress& progress, const AfterStep& after_step);

}  // namespace selvage
