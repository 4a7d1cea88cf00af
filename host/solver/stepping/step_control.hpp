#pragma once
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

#include "host/solver/stepping/integrator.hpp"
#include "host/solver/stepping/phase.hpp"
#include "host/solver/stepping/solver_snapshot.hpp"
#include "host/solver/stepping/step_failure.hpp"
#include "io/choices.hpp"

namespace selvage {

/// What the driver of a run hears after every accepted step or relaxation.
struct StepEvent {
    double time = 0;  ///< Simulated [s].
    double dt = 0;    ///< Of the step just taken; 0 for a relaxation [s].
    int newton_iterations = 0;
    int linear_iterations = 0;
    double residual = 0;  ///< Relative static force residual [1]; while sewing: largest gap over the closed gap.
    double stable_step = std::numeric_limits<double>::infinity();  ///< Limit of an explicit scheme [s].
    double shortest = 0;               ///< Shortest of the steps that dt was made of [s]; 0: one step.
    std::string_view integrator = {};  ///< That took the step; empty for a relaxation.
    double left = -1;    ///< Acceleration that a step of a timed motion has not found, over gravity [1]; -1: not asked.
    bool solved = true;  ///< False: it has been accepted although more is left than was allowed.
    double error = -1;   ///< Estimate of the step's own error in time [m]; -1: none.
};

/// Called after every accepted step; false ends the phase (an interrupt, a limit on wall time).
using AfterStep = std::function<bool(const StepEvent&)>;

enum class PhaseEnd { reached, time_limit, stopped };

struct StepOptions {
    double longest = 0.02;  ///< Step that is taken while nothing fails [s].
    bool adaptive = false;  ///< Steps follow the integrator's estimate of its error, if it has one.
    double error = 1e-4;    ///< Error of one step that adaptive steps allow [m].
    UnstableStep unstable = UnstableStep::shrink;  ///< A step above an explicit scheme's stability limit.
    double least = 1.0 / 1024;                     ///< Part of the longest step: below it a run has diverged [1].
    bool moves_boundary = false;  ///< Bodies and held vertices move with the clock; otherwise they stand still.
};

/// What StepControl takes from one step to the next; kept in checkpoints.
struct StepMemory {
    double dt = 0;                                     ///< That the next step will try; 0: the longest [s].
    int knows_energy = 0;                              ///< 1: there have been steps that may gain energy.
    double first_energy = 0;                           ///< Kinetic and potential, at the first of them [J].
    double highest_kinetic = 0, lowest_potential = 0;  ///< Before any of them so far [J].
};

/// Thrown where a step above the stability limit is to be refused.
class UnstableStepError : public std::runtime_error {
public:
    UnstableStepError(double asked, double limit);
    double limit;  ///< [s]
};

/// Takes steps of an integrator on the system's clock, and retries one that fails with half its length. Explicit
/// schemes fill a step with as many shorter ones as their stability asks for.
class StepControl {
public:
    /// The first step starts at the clock's time. The references must outlive this object.
    /// @param memory  of another one whose steps are gone on with: bodies are where they should be. Without it they are
    ///                put there.
    StepControl(Phase& phase, Integrator& integrator, const StepOptions& options, const StepMemory& memory = {});

    /// Takes one step of at most `room` seconds; the clock goes on by its length.
    /// @param accurate  a step whose Newton iterations do not reach their tolerance counts as failed
    /// @returns the length of the accepted step [s]; 0 if it was broken off, with all as it was before
    /// @throws StepFailureError when not even a thousandth of the longest step succeeds; the last good state is kept
    /// @throws UnstableStepError if the longest step is unstable and that is to be refused
    double advance(double room, const NewtonOptions& options, bool accurate);

    const NewtonReport& report() const { return report_; }  ///< Of the accepted step.
    const StepMemory& memory() const { return memory_; }
    double taken() const { return taken_; }  ///< Of the last accepted step [s].
    int retries() const { return retries_; }
    double stable_step() const { return limit_; }  ///< At the last step [s].
    double shortest() const { return shortest_; }  ///< Of the steps that the last accepted one was made of [s].
    const Integrator& integrator() const { return integrator_; }

private:
    /// What one call of advance covers, with one step or, where explicit schemes fill it, with several.
    struct Cover {
        double begin = 0, length = 0;                     ///< [s]
        double done = 0;                                  ///< Accepted so far [s].
        double first = 0;                                 ///< Length of its first step [s].
        double kinetic_before = 0, potential_before = 0;  ///< Where the integrator may gain energy [J].
    };
    /// What becomes of a step that was tried.
    enum class Verdict { accepted, failed, inaccurate, broken_off };

    void return_to(const SolverSnapshot& place, double time);
    Cover start(double room);
    double next_step(double left, bool begins, bool even);
    Verdict try_step(const Cover& cover, double dt, const NewtonOptions& options, bool accurate);
    bool solve(double dt, const NewtonOptions& options, bool accurate);
    bool fills() const { return integrator_.info().is_explicit; }
    bool adapts() const { return options_.adaptive && integrator_.info().has_error_estimate(); }
    bool ends(const Cover& cover, double dt) const;
    bool cloth_is_clear();
    bool too_inaccurate(double dt);
    bool passed_into_body(bool last);
    bool keeps_energy(const Cover& cover);
    bool fail(StepFault fault);
    void note_failure(double dt);
    void shrink(double dt);

    System& system_;
    Integrator& integrator_;
    StepOptions options_;
    StepMemory memory_;
    bool moves_;  ///< Bodies or held vertices.
    double taken_ = 0, shortest_ = 0;
    double floor_ = 0;  ///< Steps below it mean that the run has diverged [s].
    double limit_ = std::numeric_limits<double>::infinity();
    int retries_ = 0;
    NewtonReport report_;
    StepFailure failure_;  ///< What is known of the last attempt that failed.
    SolverSnapshot start_, last_;
    std::vector<real> looked_from_;  ///< Positions at the last look for ways into bodies.
};

}  // namespace selvage
