// Backward differences of second order with steps of any lengths. The velocity at the end of a step is the slope there
// of the parabola through the last three positions, and a part of the way to that of the cubic through the last four:
//     x1 = x0 + h (v1 + b1 w1/dt1 + b2 (w1/dt1 - w2/dt2)),   the same for v1 and a1,
// with the ways w1, w2 of the two steps before and their lengths dt1, dt2. That part halves the error of the second
// order and takes the most of its damping off slow motions, while fast modes are damped as before. On the way to rest
// it is left out. The first step is one of the implicit midpoint rule where the cloth is at rest: with implicit
// Euler's, fast modes show its first order for long. It ends beyond what was solved for, where cloth could have met
// itself, or where cloth that turns is stretched: with contact of cloth it is one of implicit Euler. So it is after a
// velocity filter has moved the state, since that happens step after step and the midpoint rule damps nothing. Cloth
// that moves has its step before made up. Source: Gear 1971; Hairer, Norsett and Wanner 1993, ch. III.5 for variable
// steps; Vatsa, Carpenter and Lockard 2010 for the blend.
#include <algorithm>

#include "host/parallel/launch.hpp"
#include "host/solver/state/vectors.hpp"
#include "host/solver/stepping/integrators/list.hpp"
#include "host/solver/stepping/integrators/rigid_flight.hpp"
#include "host/solver/stepping/phase.hpp"
#include "kernels/stages/integrator_steps.h"

namespace selvage {
namespace {

constexpr double after_rule = -1;  // in place of the length of the step before
// The part of the cubic. At most 0.5 is stable for all oscillations in equal steps; where steps of two lengths take
// turns, one 1.5 times the other as between frames, 0.48 still is and 0.5 is not.
constexpr double part_of_cubic = 0.48;
constexpr double widest_ratio = 1.6;  // of the lengths of steps that follow each other: beyond it there is no cubic

struct Weights {
    double span = 0;             // h [s]
    double last = 0, older = 0;  // of the ways and gains of the two steps before [1]
    double part = 0;             // of the cubic
};

// @param dt  [s]   @param before  lengths of the last step and of that before it; 0 or less: there was none
// @param towards_rest  the cubic is left out: without the parabola's damping heaps rattle on
Weights weights_of(double dt, const std::vector<real>& before, bool towards_rest)
{
    const double dt1 = before[0], dt2 = before[1];
    if (!(dt1 > 0)) return {.span = dt};
    const auto alike = [](double a, double b) { return a <= widest_ratio * b && b <= widest_ratio * a; };
    const bool cubic = !towards_rest && dt2 > 0 && alike(dt, dt1) && alike(dt1, dt2);
    Weights w{.part = cubic ? part_of_cubic : 0};
    const double all = dt + dt1 + (cubic ? dt2 : 0), share = dt / (dt + dt1) + w.part * dt / all;
    w.span = dt / (1 + share);
    const double bend = cubic ? w.part * dt * (dt + dt1) / (all * (dt1 + dt2)) : 0;
    w.last = w.span * (share + bend) / dt1;
    w.older = cubic ? -w.span * bend / dt2 : 0;
    return w;
}

class Bdf2 final : public Integrator {
public:
    Bdf2(Phase& phase, const IntegratorInfo& info) : phase_(phase), info_(info), flight_(phase.state())
    {
        for (std::vector<real>* v : {&last_way_, &last_gain_, &older_way_, &older_gain_, &origin_, &target_, &guess_})
            v->assign(phase.state().pos.size(), 0);
    }
    const IntegratorInfo& info() const override { return info_; }
    void restart() override { last_dt_ = {0, 0}; }
    void displaced() override { last_dt_ = {after_rule, 0}; }
    std::vector<HistoryArray> history() override
    {
        return {{"last_way", &last_way_},
                {"last_gain", &last_gain_},
                {"older_way", &older_way_},
                {"older_gain", &older_gain_},
                {"last_dt", &last_dt_}};
    }
    double error_estimate() const override { return error_; }

    NewtonReport step(double dt, const NewtonOptions& options) override
    {
        State& s = phase_.state();
        const bool solves = options.acceleration_left > 0;
        if (solves && last_dt_[0] == 0 && largest_square(s, s.vel) > 0) make_up_last_step(dt);
        const bool first = last_dt_[0] <= 0;
        const bool midpoint = last_dt_[0] == 0 && !phase_.cloth_contact() && largest_square(s, s.vel) == 0;
        Weights weights = weights_of(dt, last_dt_, options.towards_rest);
        if (midpoint) weights.span = 0.5 * dt;
        const double w = first ? 0 : dt / last_dt_[0], h = weights.span;
        const double parabola = first ? 0 : w * w;
        // Ways and gains instead of old positions and velocities: pinned vertices then stay to the last bit.
        const bdf2_args args{s.pos.data(),
                             s.vel.data(),
                             last_way_.data(),
                             last_gain_.data(),
                             older_way_.data(),
                             older_gain_.data(),
                             origin_.data(),
                             target_.data(),
                             guess_.data(),
                             dt,
                             w,
                             h,
                             weights.last,
                             weights.older,
                             parabola,
                             midpoint};
        const int n = int(s.pos.size());
        if (solves) predict(midpoint ? h : dt, midpoint ? h * h : first ? dt * dt : 0.5 * dt * dt);
        launch<bdf2_start>(n, args);
        const std::vector<real>* expected = solves ? &flown_ : first ? nullptr : &guess_;
        const NewtonReport report = phase_.newton().minimise(h, origin_, target_, options, expected);
        launch<bdf2_finish>(n, args);
        last_dt_ = {dt, std::max(last_dt_[0], 0.0)};
        phase_.system().settle();
        // At first free flight is the guess, and its error a bound.
        // Later the guess errs by -(1 + w)/w dt^3 x'''/6, the step by (1 - part) h/dt of as much the other way (Milne's
        // device).
        const double step = (1 - weights.part) * h / dt;
        error_ = (first ? 1 : step / (1 + step)) * largest_distance(s, s.pos, guess_);
        return report;
    }

private:
    // Where the cloth flies on rigidly, with the acceleration of the last step or, at first, that of gravity.
    void predict(double ahead, double half)
    {
        fill_acceleration(phase_.state(), phase_.params(), last_gain_, last_dt_[0], acceleration_);
        flight_.predict(phase_.state(), ahead, half, acceleration_, flown_);
    }

    // Cloth that moves as the steps begin came from where rigid flight leads backward: implicit Euler's first step
    // would take speed off it, 0.9 % of a spin.
    void make_up_last_step(double dt)
    {
        const State& s = phase_.state();
        fill_gravity(s, phase_.params(), acceleration_);
        flight_.fly(s, -dt, acceleration_, last_way_, last_gain_);
        scale_difference(last_way_, 1, s.pos, last_way_);
        scale_difference(last_gain_, 1, s.vel, last_gain_);
        last_dt_ = {dt, 0};
    }

    Phase& phase_;
    const IntegratorInfo& info_;
    RigidFlight flight_;
    std::vector<real> last_way_, last_gain_, older_way_, older_gain_, last_dt_{0, 0}, origin_, target_, guess_,
        acceleration_, flown_;
    double error_ = 0;
};

}  // namespace

std::unique_ptr<Integrator> make_bdf2_integrator(Phase& phase, const IntegratorInfo& info)
{
    return std::make_unique<Bdf2>(phase, info);
}

}  // namespace selvage
