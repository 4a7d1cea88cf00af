#include "host/solver/stepping/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/solver/stepping/sleep.hpp"

namespace selvage {
namespace {

constexpr int relax_chunk = 5;  // static iterations between two looks at interrupts and limits
constexpr int relax_chunks = 12;
constexpr double first_load = 0.05;   // part of the weight at the first of several load steps
constexpr int steps_between = 8;      // motion after a static attempt that did not reach the tolerance
constexpr double too_early = 0.05;    // residual above which an attempt must not meet negative curvature all the time
constexpr int patience = 25;          // motion after which one is made again although the forces do not fall further
constexpr double stride = 2;          // steps towards rest, of those of a motion: only where they lead counts
constexpr double swing_stride = 1.5;  // the same while the cloth swings

// What a static attempt that is interrupted gives back, so that a resumed run repeats it from its start.
struct SavedShape {
    std::vector<real> pos, vel, anchor, limit, hinge_anchor, pairs;
};

SavedShape shape_of(const Phase& phase)
{
    const State& s = phase.state();
    const ClothContact* cloth = phase.cloth_contact();
    return {s.pos,
            s.vel,
            s.friction_anchor,
            s.friction_limit,
            s.hinge_anchor,
            cloth ? cloth->memory() : std::vector<real>{}};
}

void restore(Phase& phase, const SavedShape& saved)
{
    State& state = phase.state();
    if (phase.cloth_contact()) phase.cloth_contact()->memory() = saved.pairs;
    state.pos = saved.pos;
    state.vel = saved.vel;
    state.friction_anchor = saved.anchor;
    state.friction_limit = saved.limit;
    state.hinge_anchor = saved.hinge_anchor;
}

// Minimises the static energy. It never rises, so an attempt that falls short still leaves the cloth nearer to rest.
// @param swung  BDF2 has led here: it leads past saddles, so that an attempt which finds only such at first is given up
PhaseEnd relax(Phase& phase, const EquilibriumOptions& options, DrapeProgress& progress, const AfterStep& after_step,
               bool swung)
{
    NewtonOptions newton;
    newton.max_iterations = relax_chunk;
    newton.tolerance = options.tolerance;
    newton.linear_tolerance = 0.02;
    newton.full_stiffness = true;
    newton.stop = &options.stop;
    const SavedShape start = shape_of(phase);
    const double began = progress.residual;
    double best = 1e300;
    for (int chunk = 0; chunk < relax_chunks; ++chunk) {
        const NewtonReport report = phase.newton().relax(newton);
        if (report.broken_off ||
            !after_step({progress.time, 0, report.iterations, report.linear_iterations, report.residual})) {
            restore(phase, start);
            return PhaseEnd::stopped;
        }
        if (report.converged) return PhaseEnd::reached;
        const bool buckles = report.blind == report.iterations && report.iterations > 0;  // inertia has to lead it on
        const bool unstable = swung && chunk == 0 && report.negative == report.iterations && began > too_early;
        const bool ends = report.stuck || buckles || unstable;
        if (chunk + 1 == relax_chunks || ends) progress.residual = report.residual;
        if (ends || (chunk > 3 && report.residual > 0.8 * best)) return PhaseEnd::time_limit;
        best = std::min(best, report.residual);
    }
    return PhaseEnd::time_limit;
}

bool nearly_balanced(const Phase& phase, const EquilibriumOptions& options, const DrapeProgress& progress)
{
    if (progress.time < phase.motion_end()) return false;
    if (progress.residual <= options.tolerance) return true;
    const bool creeps = progress.hold <= -patience && progress.residual <= DrapeProgress{}.switch_residual;
    return creeps || (progress.hold <= 0 && progress.residual <= progress.switch_residual);
}

// The integrator of the options, or one that is made here.
Integrator& chosen(const EquilibriumOptions& options, Phase& phase, std::unique_ptr<Integrator>& own)
{
    if (options.integrator) return *options.integrator;
    own = make_integrator("implicit_euler", phase);
    return *own;
}

StepOptions starting_at(double time, StepOptions options)
{
    options.start = time;
    return options;
}

StepEvent event_of(const StepControl& control, const DrapeProgress& progress)
{
    return {progress.time,     control.taken(),       control.report().iterations, control.report().linear_iterations,
            progress.residual, control.stable_step(), control.shortest()};
}

// Whether a step may be left unsolved: what an iteration leaves over, a damped scheme of first order makes up for
// later. Friction remembers the way, though: who lets the weight grow in steps asks for a way that is followed.
bool may_hurry(const Integrator& integrator, const EquilibriumOptions& options)
{
    return options.hurries && !integrator.info().is_explicit && integrator.info().order <= 2 &&
           !options.step.adaptive && options.load_steps == 1;
}

void wake_all(Phase& phase, DrapeProgress& progress)
{
    if (progress.asleep > 0) wake(phase);
    progress.asleep = 0;
}

// Whether all is at rest where what is awake is.
PhaseEnd rest_of_all(Phase& phase, const EquilibriumOptions& options, DrapeProgress& progress)
{
    wake_all(phase, progress);
    progress.residual = phase.newton().static_residual();
    return progress.residual <= options.tolerance ? PhaseEnd::reached : PhaseEnd::time_limit;
}

// The way to rest under the present weight.
class WayToRest {
public:
    WayToRest(Phase& phase, Integrator& integrator, const EquilibriumOptions& options, DrapeProgress& progress,
              const AfterStep& after_step)
        : phase_(phase), integrator_(integrator), options_(options), progress_(progress), after_step_(after_step),
          hurries_(may_hurry(integrator, options)), swings_first_(hurries_ && integrator.info().order > 1)
    {
        newton_.stop = &options.stop;
        newton_.tolerance = 0.3 * options.tolerance;  // a looser one would let a step do nothing near the end
        choose_steps();
        if (progress.dt > 0) control_->set_dt(progress.dt);
    }

    PhaseEnd go()
    {
        for (;;) {
            if (nearly_balanced(phase_, options_, progress_)) {
                if (options_.only_balances) {
                    wake_all(phase_, progress_);
                    return PhaseEnd::reached;
                }
                const std::optional<PhaseEnd> end = try_statics();
                if (end) return *end;
            }
            if (progress_.time >= options_.max_time) {
                wake_all(phase_, progress_);
                return PhaseEnd::time_limit;
            }
            if (!step()) return PhaseEnd::stopped;
        }
    }

private:
    // Cloth that falls and swings is followed until its forces first nearly balance. Hurried steps are so stiff that
    // they would creep where momentum carries the cloth on, and end in higher folds.
    bool swings() const { return swings_first_ && progress_.switch_residual >= DrapeProgress{}.switch_residual; }

    void choose_steps()
    {
        StepOptions steps = starting_at(progress_.time, options_.step);
        const bool hurries = hurries_ && !swings();
        if (hurries_) steps.longest *= hurries ? stride : swing_stride;
        if (hurries && swings_first_) hurried_ = make_integrator("implicit_euler", phase_);
        control_.emplace(phase_, hurried_ ? *hurried_ : integrator_, steps);
        longest_ = steps.longest;
    }

    // Returns how the way ends, if it does.
    std::optional<PhaseEnd> try_statics()
    {
        const bool was_part = progress_.asleep > 0, swung = swings();
        PhaseEnd end = relax(phase_, options_, progress_, after_step_, swings_first_);
        if (end == PhaseEnd::stopped) return end;
        if (was_part && end == PhaseEnd::reached) end = rest_of_all(phase_, options_, progress_);
        wake_all(phase_, progress_);
        if (end == PhaseEnd::reached) return end;
        integrator_.restart();
        if (was_part && progress_.residual <= 10 * options_.tolerance) return {};  // the rest is near its place
        progress_.switch_residual = std::max(0.5 * progress_.switch_residual, 2 * options_.tolerance);
        progress_.hold = steps_between;
        if (swung) {
            progress_.dt = 0;
            choose_steps();
        }
        return {};
    }

    bool step()
    {
        const bool follows = progress_.time < phase_.motion_end();  // bodies or pins, whose way counts
        const bool hurries = hurries_ && !follows && !swings();
        newton_.max_iterations = std::min(options_.newton_iterations, hurries ? 1 : 3);
        progress_.time += control_->advance(follows ? options_.step.longest : longest_, newton_, false);
        if (control_->report().broken_off) return false;
        progress_.dt = control_->dt();
        progress_.residual = phase_.newton().static_residual();
        if (hurries_ && !follows && options_.sleeps) {
            const bool all_awake = progress_.asleep == 0;
            rest_in_places(phase_, progress_.asleep);
            if (all_awake && progress_.asleep > 0) integrator_.displaced();  // what sleeps has stopped
        }
        --progress_.hold;
        return after_step_(event_of(*control_, progress_));
    }

    Phase& phase_;
    Integrator& integrator_;
    const EquilibriumOptions& options_;
    DrapeProgress& progress_;
    const AfterStep& after_step_;
    const bool hurries_;       // sooner or later
    const bool swings_first_;  // with a scheme of second order, which implicit Euler then takes over from
    NewtonOptions newton_;
    std::unique_ptr<Integrator> hurried_;  // implicit Euler, once it has taken over
    std::optional<StepControl> control_;
    double longest_ = 0;
};

}  // namespace

PhaseEnd drape_to_equilibrium(Phase& phase, const EquilibriumOptions& options, DrapeProgress& progress,
                              const AfterStep& after_step)
{
    std::unique_ptr<Integrator> own;
    Integrator& integrator = chosen(options, phase, own);
    const auto whole = phase.params().gravity;
    const double first = std::log(first_load);
    PhaseEnd end = PhaseEnd::reached;
    while (progress.load < options.load_steps && end == PhaseEnd::reached) {
        const int left = options.load_steps - 1 - progress.load;
        const double part = left == 0 ? 1 : std::exp(first * left / (options.load_steps - 1));
        auto& gravity = phase.params().gravity;
        gravity.acceleration_x = part * whole.acceleration_x;
        gravity.acceleration_y = part * whole.acceleration_y;
        gravity.acceleration_z = part * whole.acceleration_z;
        end = WayToRest(phase, integrator, options, progress, after_step).go();
        if (end == PhaseEnd::reached && left > 0)
            progress = DrapeProgress{.time = progress.time, .load = progress.load};
        if (end == PhaseEnd::reached) ++progress.load;
    }
    phase.params().gravity = whole;
    return end;
}

PhaseEnd drape_until(Phase& phase, const EquilibriumOptions& options, double until, double frame_interval,
                     DrapeProgress& progress, const AfterStep& after_step)
{
    std::unique_ptr<Integrator> own;
    StepControl control(phase, chosen(options, phase, own), starting_at(progress.time, options.step));
    if (progress.dt > 0) control.set_dt(progress.dt);
    NewtonOptions newton;
    newton.max_iterations = options.newton_iterations;
    newton.tolerance = 1e-2;
    newton.still = 3e-2;
    newton.decrement = 1e-2;
    newton.linear_tolerance = 0.2;
    newton.stop = &options.stop;
    newton.most_left = 0.12 * phase.edge_length();
    while (progress.time < until - 1e-9) {
        // Steps end on frame times, so that frames show computed states and not interpolated ones.
        const double frame_end = frame_interval * (std::floor(progress.time / frame_interval + 1e-6) + 1);
        progress.time += control.advance(std::min(frame_end, until) - progress.time, newton, true);
        if (control.report().broken_off) return PhaseEnd::stopped;
        progress.dt = control.dt();
        StepEvent event = event_of(control, progress);
        event.residual = phase.newton().static_residual();
        if (!after_step(event)) return PhaseEnd::stopped;
    }
    return PhaseEnd::reached;
}

}  // namespace selvage
