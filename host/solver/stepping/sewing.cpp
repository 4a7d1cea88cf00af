#include "host/solver/stepping/sewing.hpp"

#include <algorithm>
#include <cmath>

#include "host/parallel/launch.hpp"
#include "host/parallel/trace.hpp"
#include "host/solver/state/planes.hpp"

namespace selvage {
namespace {

// How seams are pulled closed and pressed. Where nothing else is said, chosen by hand on the built-in garments and on
// 39 patterns of others; not measured one by one.
struct SewingTuning {
    static constexpr int steps_between_looks = 5;  // at pairs that have come close: making a phase costs some steps
    static constexpr double fast = 0.6;     // factor by which the gaps shrink between looks that need no such pull
    static constexpr double headway = 0.8;  // factor by which the gaps must shrink between looks
    static constexpr double stiffness_growth = 2;  // factor of the seam's stiffness when it is pulled harder
    static constexpr double limit_growth = 1.5;    // factor of the seam's force limit at the same time
    static constexpr int hardest = 10;             // times that it may be
    static constexpr int hardest_on_whole = 4;     // times, before bodies that can be thin are made so
    static constexpr int patience = 8;             // looks without headway at the hardest pull: given up
    // What stays a little apart at a stronger pull is welded as well: pairs in folds, next to those that are welded.
    static constexpr double reach_growth =
        0.5;  // of the gap that is welded, for each time that seams are pulled harder
    static constexpr double reach_of_edge = 0.3;  // of an edge length: that gap at most, unless the scene says more
    static constexpr double barrier_bears = 56;  // times its stiffness, as a pressure at 0.02 of its gap: see barrier.h
    static constexpr int most_failures = 6;      // steps without success that sewing survives
    static constexpr double shortest_step = 0.05;  // of the scene's: shorter ones mean that things jam
    static constexpr int most_settling = 8;        // steps on bodies that have their size
    static constexpr double press_bending = 100;   // times the fabric's bending rigidity: laps at seams fold open
    static constexpr int press_steps = 20;         // of pressing
};

}  // namespace

double largest_gap(const Phase& phase)
{
    const State& s = phase.state();
    const auto& stitches = phase.topology().stitches;
    const ConstPlanes x = vertex_planes(s.size, s.pos);
    return std::sqrt(max_items(int(stitches.size()), [&](int k) {
        const Vec3 d = x(stitches[k][0]) - x(stitches[k][1]);
        double squared = 0;
        for (int c = 0; c < 3; ++c) squared += d[c] * d[c];
        return squared;
    }));
}

std::vector<char> coinciding_pairs(const Cloth& cloth)
{
    std::vector<char> pairs;
    for (const auto& [a, b] : cloth.seam_pairs) pairs.push_back(cloth.positions[a] == cloth.positions[b]);
    return pairs;
}

bool all_welded(const std::vector<char>& welded)
{
    return std::all_of(welded.begin(), welded.end(), [](char one) { return one != 0; });
}

double pull_limit(const SewingOptions& options, const SewingProgress& progress)
{
    return options.first_limit * std::pow(SewingTuning::limit_growth, progress.harder);
}

void bear_pull(Params& params, double pull, double edge_length)
{
    const double pressure = pull / (edge_length * edge_length);
    for (double* stiffness : {&params.body_contact.stiffness, &params.cloth_contact.stiffness})
        if (*stiffness > 0) *stiffness = std::max(*stiffness, pressure / SewingTuning::barrier_bears);
}

namespace {

void set_pull(SewnCloth& cloth, const SewingOptions& options, const SewingProgress& progress)
{
    Params& params = cloth.phase->params();
    params.seam.stiffness = options.first_stiffness * std::pow(SewingTuning::stiffness_growth, progress.harder);
    params.seam.force_limit = pull_limit(options, progress);
    params.body_contact.stiffness = cloth.options.params.body_contact.stiffness;
    params.cloth_contact.stiffness = cloth.options.params.cloth_contact.stiffness;
    if (cloth.options.local_stiffness) bear_pull(params, params.seam.force_limit, options.edge_length);
}

}  // namespace

void remake_phase(SewnCloth& cloth, const SewingOptions& options, const SewingProgress& progress,
                  const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities, Clock clock)
{
    const TraceScope scope("remake_phase");
    cloth.options.welded = progress.welded;
    cloth.phase.reset();  // two phases at once would double the memory
    cloth.phase =
        std::make_unique<Phase>(cloth.model, cloth.options, cloth.query, cloth.profile, positions, velocities);
    System& system = cloth.phase->system();
    system.clock() = clock;
    if (system.motion_end() > 0) {
        system.place_boundary();
        system.find_contacts();
    }
    set_pull(cloth, options, progress);
    cloth.remade();
}

namespace {

// Steps of a cloth that is being sewn.
class Sewing {
public:
    Sewing(SewnCloth& cloth, const SewingOptions& options, SewingProgress& progress, const AfterStep& after_step)
        : cloth_(cloth), options_(options), progress_(progress), after_step_(after_step)
    {
        newton_.max_iterations = 3;  // on the way to a closed seam accuracy in time is worth nothing
        newton_.tolerance = 1e-2;
        newton_.stop = &cloth.stop;
        renew();
    }

    bool broken_off() const { return control_->report().broken_off; }
    double time() const { return cloth_.phase->system().clock().time; }

    // Looks at the pairs if it is time to: welds those that are close, or pulls harder.
    void look()
    {
        if (progress_.steps_since_look < SewingTuning::steps_between_looks || all_welded(progress_.welded)) return;
        progress_.steps_since_look = 0;
        const std::vector<Vec3> positions = cloth_.phase->positions();
        const auto& pairs = cloth_.model.cloth.seam_pairs;
        const double most = std::max(options_.closed, SewingTuning::reach_of_edge * options_.edge_length);
        const double reach = std::min(most, options_.closed * (1 + SewingTuning::reach_growth * progress_.harder));
        double open_way = 0;
        bool closed = false;
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            if (progress_.welded[k]) continue;
            const double gap = (positions[pairs[k][0]] - positions[pairs[k][1]]).norm();
            progress_.welded[k] = gap <= reach;
            closed = closed || progress_.welded[k];
            open_way += progress_.welded[k] ? 0 : gap;
        }
        change_pull(open_way / progress_.open_way);
        progress_.open_way = open_way;
        if (!closed) return;
        remake_phase(cloth_, options_, progress_, positions, cloth_.phase->velocities(),
                     cloth_.phase->system().clock());
        renew();
    }

    // Begins again at rest and with the first pull where a step has failed: whatever crosses by now is let go.
    void recover()
    {
        ++progress_.failures;
        progress_.harder = 0;
        progress_.steps = {};
        const Clock clock = cloth_.phase->system().clock();
        remake_phase(cloth_, options_, progress_, cloth_.phase->positions(), {}, clock);
        renew();
    }

    // Returns whether the run goes on.
    bool step()
    {
        try {
            control_->advance(options_.step, newton_, false);
        } catch (const StepFailureError&) {
            if (progress_.failures >= SewingTuning::most_failures) throw;
            recover();
            return true;
        }
        if (control_->report().broken_off) return false;
        progress_.steps = control_->memory();
        ++progress_.steps_since_look;
        const System& system = cloth_.phase->system();
        const double energy = system.energy_of(EnergyFamily::membrane) + system.energy_of(EnergyFamily::bending);
        progress_.energy_change = std::abs(energy - progress_.elastic_energy) / std::max(energy, 1e-12);
        progress_.elastic_energy = energy;
        const NewtonReport& report = control_->report();
        return after_step_({time(), control_->taken(), report.iterations, report.linear_iterations,
                            largest_gap(*cloth_.phase) / options_.closed});
    }

private:
    void renew()
    {
        control_.reset();
        euler_ = make_integrator("implicit_euler", *cloth_.phase);
        control_.emplace(
            *cloth_.phase, *euler_,
            StepOptions{.longest = options_.step, .least = SewingTuning::shortest_step, .moves_boundary = true},
            progress_.steps);
    }

    // @param part  of the sum of all gaps that is left since the last look
    void change_pull(double part)
    {
        if (part < SewingTuning::fast) {
            progress_.harder = std::max(progress_.harder - 1, 0);
            progress_.looks_in_vain = 0;
        } else if (part > SewingTuning::headway) {
            if (progress_.harder == SewingTuning::hardest) ++progress_.looks_in_vain;
            progress_.harder = std::min(progress_.harder + 1, SewingTuning::hardest);
        }
        set_pull(cloth_, options_, progress_);
    }

    SewnCloth& cloth_;
    const SewingOptions& options_;
    SewingProgress& progress_;
    const AfterStep& after_step_;
    NewtonOptions newton_;
    std::unique_ptr<Integrator> euler_;
    std::optional<StepControl> control_;
};

}  // namespace

PhaseEnd close_seams(SewnCloth& cloth, const SewingOptions& options, SewingProgress& progress,
                     const AfterStep& after_step)
{
    Sewing sewing(cloth, options, progress, after_step);
    for (;;) {
        sewing.look();
        if (all_welded(progress.welded)) return PhaseEnd::reached;
        const bool can_be_thinner = options.thin > 0 && !progress.on_thin;
        const bool in_vain = can_be_thinner ? progress.failures > 0 || progress.harder > SewingTuning::hardest_on_whole
                                            : progress.failures >= SewingTuning::most_failures ||
                                                  progress.looks_in_vain >= SewingTuning::patience;
        if (in_vain || sewing.time() >= options.max_time) return PhaseEnd::time_limit;
        if (!sewing.step()) return PhaseEnd::stopped;
    }
}

PhaseEnd let_bodies_grow(SewnCloth& cloth, const SewingOptions& options, SewingProgress& progress,
                         const AfterStep& after_step)
{
    Sewing sewing(cloth, options, progress, after_step);
    const auto grown = [&] { return sewing.time() >= cloth.phase->system().motion_end(); };
    const auto settled = [&] {
        return progress.settled_steps >= SewingTuning::most_settling ||
               (progress.settled_steps > 0 && progress.energy_change <= options.energy_tolerance);
    };
    while (!grown() || !settled()) {
        sewing.look();
        const bool settles = grown();
        const int failures = progress.failures;
        progress.settled_steps += settles;
        if (!sewing.step()) {
            if (sewing.broken_off()) progress.settled_steps -= settles;
            return PhaseEnd::stopped;
        }
        if (progress.failures > failures) return PhaseEnd::time_limit;
    }
    return PhaseEnd::reached;
}

PhaseEnd press_seams(Phase& phase, double step, PressProgress& progress, const AfterStep& after_step)
{
    const Params worn = phase.params();
    phase.params().bending.scale *= SewingTuning::press_bending;
    phase.params().plate.scale *= SewingTuning::press_bending;
    phase.params().spring.bend_scale *= SewingTuning::press_bending;
    phase.params().friction.scale = 0;
    phase.params().velocity_rule.friction = 0;
    phase.params().bending_hysteresis.scale = 0;
    phase.params().gravity = {};
    const std::unique_ptr<Integrator> euler = make_integrator("implicit_euler", phase);
    StepControl control(phase, *euler, {.longest = step}, progress.steps);
    NewtonOptions newton;
    newton.max_iterations = 2;
    const Clock start = phase.system().clock();  // pressing takes none of the run's time
    PhaseEnd end = PhaseEnd::reached;
    while (progress.step < SewingTuning::press_steps && end == PhaseEnd::reached) {
        control.advance(step, newton, false);
        phase.system().clock() = start;
        ++progress.step;
        progress.steps = control.memory();
        if (!after_step({start.time, control.taken(), control.report().iterations, control.report().linear_iterations,
                         control.report().residual}))
            end = PhaseEnd::stopped;
    }
    phase.params() = worn;
    return end;
}

}  // namespace selvage
