#pragma once
#include <functional>
#include <vector>

#include "host/solver/phase.hpp"

namespace selvage {

/// What the driver of a run hears after every accepted step or relaxation.
struct StepEvent {
    double time = 0;              ///< Simulated [s].
    double dt = 0;                ///< Of the step just taken; 0 for a relaxation [s].
    int newton_iterations = 0;
    int linear_iterations = 0;
    double residual = 0;          ///< Relative static force residual [1]; while sewing: largest gap over the closed gap.
};

/// Called after every accepted step; false ends the phase (an interrupt, a limit on wall time).
using AfterStep = std::function<bool(const StepEvent&)>;

enum class PhaseEnd { reached, time_limit, stopped };

/// Takes implicit steps, and retries a step that fails with half its length.
class StepControl {
public:
    /// @param longest  step that is taken while nothing fails [s]
    StepControl(Phase& phase, double longest) : phase_(phase), longest_(longest), dt_(longest) {}

    /// Takes one step of at most `room` seconds.
    /// @param accurate  a step whose Newton iterations do not reach their tolerance counts as failed
    /// @returns the length of the accepted step [s]
    /// @throws DivergenceError when not even a thousandth of the longest step succeeds; the last good state is kept
    double advance(double room, const NewtonOptions& options, bool accurate);

    const NewtonReport& report() const { return report_; }   ///< Of the accepted step.
    double dt() const { return dt_; }          ///< That the next step will try [s].
    double taken() const { return taken_; }    ///< Of the last accepted step [s].
    void set_dt(double dt) { dt_ = dt; }
    int retries() const { return retries_; }

private:
    bool attempt(double dt, const NewtonOptions& options, bool accurate);

    Phase& phase_;
    double longest_, dt_;
    double taken_ = 0;
    int retries_ = 0;
    NewtonReport report_;
    std::vector<real> pos_, vel_, anchor_, limit_;
};

}  // namespace selvage
