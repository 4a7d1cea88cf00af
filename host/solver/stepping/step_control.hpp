#pragma once
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

#include "host/solver/stepping/integrator.hpp"
#include "host/solver/stepping/phase.hpp"

namespace selvage {

/// What the driver of a run hears after every accepted step or relaxation.
struct StepEvent {
    double time = 0;  ///< Simulated [s].
    double dt = 0;    ///< Of the step just taken; 0 for a relaxation [s].
    int newton_iterations = 0;
    int linear_iterations = 0;
    double residual = 0;  ///< Relative static force residual [1]; while sewing: largest gap over the closed gap.
    double stable_step = std::numeric_limits<double>::infinity();  ///< Limit of an explicit scheme [s].
    double shortest = 0;  ///< Shortest of the steps that dt was made of [s]; 0: one step.
};

/// Called after every accepted step; false ends the phase (an interrupt, a limit on wall time).
using AfterStep = std::function<bool(const StepEvent&)>;

enum class PhaseEnd { reached, time_limit, stopped };

/// What happens to a step above an explicit scheme's stability limit.
enum class UnstableStep { shrink, refuse };

struct StepOptions {
    double longest = 0.02;  ///< Step that is taken while nothing fails [s].
    bool adaptive = false;  ///< Steps follow the integrator's estimate of its error, if it has one (A8).
    double error = 1e-4;    ///< Error of one step that adaptive steps allow [m].
    UnstableStep unstable = UnstableStep::shrink;
    double start = std::numeric_limits<double>::quiet_NaN();  ///< Time of the first step [s]; NaN: nothing is moved.
};

/// Thrown where a step above the stability limit is to be refused.
class UnstableStepError : public std::runtime_error {
public:
    UnstableStepError(double asked, double limit);
    double limit;  ///< [s]
};

/// Takes steps of an integrator, and retries one that fails with half its length. Explicit schemes fill a step with
/// as many shorter ones as their stability asks for.
class StepControl {
public:
    /// The references must outlive this object.
    StepControl(Phase& phase, Integrator& integrator, const StepOptions& options)
        : phase_(phase), integrator_(integrator), options_(options), dt_(options.longest), clock_(options.start),
          moves_(!std::isnan(options.start) && phase.motion_end() > 0)
    {
        if (moves_) phase_.place(clock_);
    }

    /// Takes one step of at most `room` seconds.
    /// @param accurate  a step whose Newton iterations do not reach their tolerance counts as failed
    /// @returns the length of the accepted step [s]
    /// @throws DivergenceError when not even a thousandth of the longest step succeeds; the last good state is kept
    /// @throws UnstableStepError if the longest step is unstable and that is to be refused
    double advance(double room, const NewtonOptions& options, bool accurate);

    const NewtonReport& report() const { return report_; }  ///< Of the accepted step.
    double dt() const { return dt_; }                       ///< That the next step will try [s].
    double taken() const { return taken_; }                 ///< Of the last accepted step [s].
    void set_dt(double dt) { dt_ = dt; }
    int retries() const { return retries_; }
    double stable_step() const { return limit_; }  ///< At the last step [s].
    double shortest() const { return shortest_; }  ///< Of the steps that the last accepted one was made of [s].

private:
    struct Saved {
        std::vector<real> pos, vel, anchor, limit, hinge_anchor, pairs;
        std::vector<std::vector<real>> history;
    };

    void keep(Saved& saved);
    void restore(const Saved& saved);
    double next_step(double left, bool begins);
    bool attempt(double dt, const NewtonOptions& options, bool accurate);
    bool cloth_is_clear();
    bool too_inaccurate(double dt);
    bool passed_into_body(bool last);
    bool keeps_energy(double span, double kinetic_before, double potential_before);
    void give_up();
    void shrink(double dt);

    Phase& phase_;
    Integrator& integrator_;
    StepOptions options_;
    double dt_;
    double clock_;  ///< At the end of the last accepted step [s].
    bool moves_;    ///< Bodies or pins.
    double taken_ = 0, shortest_ = 0;
    double floor_ = 0;  ///< Steps below it mean that the run has diverged [s].
    double limit_ = std::numeric_limits<double>::infinity();
    double first_energy_ = std::numeric_limits<double>::quiet_NaN();  ///< Kinetic and potential, at the first step [J].
    double highest_kinetic_ = 0, lowest_potential_ = 0;               ///< Before any step so far [J].
    int retries_ = 0;
    NewtonReport report_;
    Saved start_, last_;
    std::vector<real> looked_from_;  ///< Positions at the last look for ways into bodies.
};

}  // namespace selvage
