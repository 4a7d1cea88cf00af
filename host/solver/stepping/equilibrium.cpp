#include "host/solver/stepping/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/solver/stepping/sleep.hpp"

namespace selvage {
namespace {

// When a step of a timed motion is solved.
struct MotionTuning {
    // Gradient norm over the force scale that is as good as a step with `step_tolerance` left, over that.
    static constexpr double residual = 0.3;
};

constexpr RestTuning tuning;
constexpr std::string_view hurrying_integrator = "implicit_euler";

// Minimises the static energy. It never rises, so an attempt that falls short still leaves the cloth nearer to rest.
// @param swung  the cloth has swung on its way here: that leads past saddles, so that an attempt which finds only such
//               at first is given up
PhaseEnd minimise_statics(Phase& phase, const EquilibriumOptions& options, DrapeProgress& progress,
                          const AfterStep& after_step, bool swung)
{
    NewtonOptions newton;
    newton.max_iterations = tuning.chunk;
    newton.tolerance = options.tolerance;
    newton.linear_tolerance = tuning.linear_tolerance;
    newton.full_stiffness = true;
    newton.stop = &options.stop;
    System& system = phase.system();
    SolverSnapshot start;  // a resumed run repeats an attempt that is interrupted from its start
    keep(system, nullptr, start);
    options.attempt(false);
    const double began = progress.residual;
    double best = 1e300;
    for (int chunk = 0; chunk < tuning.chunks; ++chunk) {
        const NewtonReport report = phase.newton().relax(newton);
        if (report.broken_off ||
            !after_step({system.clock().time, 0, report.iterations, report.linear_iterations, report.residual})) {
            restore_crossings(system, start);
            restore(system, nullptr, start);
            system.refresh_air();
            system.refresh_planes();
            system.refresh_pairs();
            options.attempt(true);
            return PhaseEnd::stopped;
        }
        if (report.converged) return PhaseEnd::reached;
        const bool buckles = report.indefinite == report.iterations && report.iterations > 0;  // it needs inertia
        const bool unstable =
            swung && chunk == 0 && report.negative_curvature == report.iterations && began > tuning.too_early;
        const bool ends = report.stuck || buckles || unstable;
        if (chunk + 1 == tuning.chunks || ends) progress.residual = report.residual;
        const bool stalls = chunk >= tuning.patient_chunks && report.residual > tuning.headway * best;
        if (ends || stalls) return PhaseEnd::time_limit;
        best = std::min(best, report.residual);
    }
    return PhaseEnd::time_limit;
}

bool nearly_balanced(const System& system, const EquilibriumOptions& options, const DrapeProgress& progress)
{
    if (system.clock().time < system.motion_end()) return false;
    if (progress.residual <= options.tolerance) return true;
    const bool stalls = progress.hold <= -tuning.stall_limit && progress.residual <= tuning.first_residual;
    return stalls || (progress.hold <= 0 && progress.residual <= progress.switch_residual);
}

// The integrator of the options, or one that is made here.
Integrator& chosen(const EquilibriumOptions& options, Phase& phase, std::unique_ptr<Integrator>& own)
{
    if (options.integrator) return *options.integrator;
    own = make_integrator(hurrying_integrator, phase);
    return *own;
}

StepOptions with_boundary(StepOptions options)
{
    options.moves_boundary = true;
    return options;
}

StepEvent event_of(const StepControl& control, const System& system, double residual)
{
    const NewtonReport& report = control.report();
    return {system.clock().time,
            control.taken(),
            report.iterations,
            report.linear_iterations,
            residual,
            control.stable_step(),
            control.shortest(),
            control.integrator().info().name,
            -1,
            true,
            control.integrator().info().has_error_estimate() ? control.integrator().error_estimate() : -1};
}

void wake_all(System& system, DrapeProgress& progress)
{
    if (progress.asleep > 0) wake(system);
    progress.asleep = 0;
}

// Whether all is at rest where what is awake is.
PhaseEnd rest_of_all(System& system, const EquilibriumOptions& options, DrapeProgress& progress)
{
    wake_all(system, progress);
    system.refresh_pairs();
    progress.residual = system.residual();
    return progress.residual <= options.tolerance ? PhaseEnd::reached : PhaseEnd::time_limit;
}

// The way to rest under the present weight: a motion in one of the modes, and static attempts in between.
class WayToRest {
public:
    WayToRest(Phase& phase, Integrator& integrator, const EquilibriumOptions& options, DrapeProgress& progress,
              const AfterStep& after_step)
        : phase_(phase), system_(phase.system()), integrator_(integrator), options_(options), progress_(progress),
          after_step_(after_step), first_mode_(first_mode(integrator.info(), options))
    {
        newton_.stop = &options.stop;
        newton_.towards_rest = true;
        newton_.tolerance = tuning.step_tolerance * options.tolerance;
        enter_mode();
    }

    PhaseEnd go()
    {
        for (;;) {
            if (nearly_balanced(system_, options_, progress_)) {
                if (options_.only_balances) {
                    wake_all(system_, progress_);
                    return PhaseEnd::reached;
                }
                const std::optional<PhaseEnd> end = try_statics();
                if (end) return *end;
            }
            if (system_.clock().time >= options_.max_time) {
                wake_all(system_, progress_);
                return PhaseEnd::time_limit;
            }
            if (!step()) return PhaseEnd::stopped;
        }
    }

private:
    // The mode that the progress stands for: a run that is resumed finds it again. Swinging ends when the first static
    // attempt fails, which lowers the residual that the next one waits for.
    RestMode mode_now() const
    {
        const bool failed = progress_.switch_residual < tuning.first_residual;
        return first_mode_ == RestMode::swing && failed ? RestMode::hurry : first_mode_;
    }

    void enter_mode()
    {
        mode_ = mode_now();
        StepOptions steps = with_boundary(options_.step);
        if (mode_ == RestMode::swing) steps.longest *= tuning.swing_factor;
        if (mode_ == RestMode::hurry) steps.longest *= tuning.hurry_factor;
        if (mode_ != first_mode_) successor_ = make_integrator(hurrying_integrator, phase_);
        control_.emplace(phase_, successor_ ? *successor_ : integrator_, steps, progress_.steps);
        longest_ = steps.longest;
    }

    // Returns how the way ends, if it does.
    std::optional<PhaseEnd> try_statics()
    {
        const bool was_part = progress_.asleep > 0;
        PhaseEnd end = minimise_statics(phase_, options_, progress_, after_step_, first_mode_ == RestMode::swing);
        if (end == PhaseEnd::stopped) return end;
        if (was_part && end == PhaseEnd::reached) end = rest_of_all(system_, options_, progress_);
        wake_all(system_, progress_);
        if (end == PhaseEnd::reached) return end;
        integrator_.restart();
        if (was_part && progress_.residual <= tuning.near_rest * options_.tolerance) return {};
        progress_.switch_residual =
            std::max(tuning.less_residual * progress_.switch_residual, tuning.least_residual * options_.tolerance);
        progress_.hold = tuning.steps_between;
        if (mode_ == RestMode::swing) {
            progress_.steps = {};
            enter_mode();
        }
        return {};
    }

    bool step()
    {
        const bool boundary_moves = system_.clock().time < system_.motion_end();  // and where it leads counts
        const bool hurries = mode_ == RestMode::hurry && !boundary_moves;
        newton_.max_iterations =
            std::min(options_.newton_iterations, hurries ? tuning.hurry_iterations : tuning.most_iterations);
        control_->advance(boundary_moves ? options_.step.longest : longest_, newton_, false);
        if (control_->report().broken_off) return false;
        progress_.steps = control_->memory();
        system_.refresh_pairs();
        const std::vector<real>& force = system_.static_force();
        progress_.residual = system_.residual_of(force);
        if (first_mode_ != RestMode::follow && !boundary_moves && options_.sleeps) {
            const bool all_awake = progress_.asleep == 0;
            rest_in_places(system_, force, progress_.asleep);
            if (all_awake && progress_.asleep > 0) integrator_.displaced();  // what sleeps has stopped
        }
        --progress_.hold;
        return after_step_(event_of(*control_, system_, progress_.residual));
    }

    Phase& phase_;
    System& system_;
    Integrator& integrator_;
    const EquilibriumOptions& options_;
    DrapeProgress& progress_;
    const AfterStep& after_step_;
    const RestMode first_mode_;
    RestMode mode_ = RestMode::follow;
    NewtonOptions newton_;
    std::unique_ptr<Integrator> successor_;  // once it has taken over
    std::optional<StepControl> control_;
    double longest_ = 0;
};

}  // namespace

RestMode first_mode(const IntegratorInfo& chosen, const EquilibriumOptions& options)
{
    const bool hurries = options.hurries && !chosen.is_explicit && chosen.order <= 2 && !options.step.adaptive &&
                         options.load_steps == 1;
    if (!hurries) return RestMode::follow;
    return chosen.order > 1 ? RestMode::swing : RestMode::hurry;
}

std::string_view successor(const IntegratorInfo& chosen, const EquilibriumOptions& options)
{
    return first_mode(chosen, options) == RestMode::swing ? hurrying_integrator : std::string_view();
}

PhaseEnd drape_to_equilibrium(Phase& phase, const EquilibriumOptions& options, DrapeProgress& progress,
                              const AfterStep& after_step)
{
    std::unique_ptr<Integrator> own;
    Integrator& integrator = chosen(options, phase, own);
    const auto whole = phase.params().gravity;
    const double first = std::log(tuning.first_load);
    PhaseEnd end = PhaseEnd::reached;
    while (progress.load < options.load_steps && end == PhaseEnd::reached) {
        const int left = options.load_steps - 1 - progress.load;
        const double part = left == 0 ? 1 : std::exp(first * left / (options.load_steps - 1));
        auto& gravity = phase.params().gravity;
        gravity.acceleration_x = part * whole.acceleration_x;
        gravity.acceleration_y = part * whole.acceleration_y;
        gravity.acceleration_z = part * whole.acceleration_z;
        end = WayToRest(phase, integrator, options, progress, after_step).go();
        if (end == PhaseEnd::reached && left > 0) progress = DrapeProgress{.load = progress.load};
        if (end == PhaseEnd::reached) ++progress.load;
    }
    phase.params().gravity = whole;
    return end;
}

PhaseEnd drape_until(Phase& phase, const EquilibriumOptions& options, double until, double frame_interval,
                     DrapeProgress& progress, const AfterStep& after_step)
{
    std::unique_ptr<Integrator> own;
    StepControl control(phase, chosen(options, phase, own), with_boundary(options.step), progress.steps);
    NewtonOptions newton;
    newton.max_iterations = options.newton_iterations;
    newton.tolerance = MotionTuning::residual * options.step_tolerance;
    newton.acceleration_left = options.step_tolerance * phase.system().gravity_scale();
    newton.stop = &options.stop;
    System& system = phase.system();
    while (system.clock().time < until - 1e-9) {
        const double time = system.clock().time;
        // Steps end on frame times, so that frames show computed states and not interpolated ones.
        const double frame_end = frame_interval * (std::floor(time / frame_interval + 1e-6) + 1);
        control.advance(std::min(frame_end, until) - time, newton, true);
        if (control.report().broken_off) return PhaseEnd::stopped;
        progress.steps = control.memory();
        system.refresh_pairs();
        StepEvent event = event_of(control, system, system.residual());
        if (!control.integrator().info().is_explicit) {
            event.left = control.report().acceleration_left / system.gravity_scale();
            event.solved = control.report().converged;
        }
        if (!after_step(event)) return PhaseEnd::stopped;
    }
    return PhaseEnd::reached;
}

}  // namespace selvage
