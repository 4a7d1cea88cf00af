// Motion at the default settings against closed forms of rigid bodies, over all stiffnesses: pendulums, a card that x,
// free fall, free spin. Stiff cloth moves like a rigid plate only if its steps are solved.
#include "validation/cases/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "host/solver/stepping/step_failure.hpp"
#include "validation/cases/cases.hpp"

namespace selvage {

std::string motion_fabric(double stretch, double bending, double density)
{
    return fmt::format(
        "[fabric.f]\nareal_density={1}\nthickness=0.0003\nstretch_weft={0}\nstretch_warp={0}\n"
        "shear={2}\nbending_weft={3}\nbending_warp={3}\nfriction=0\ndamping=0\n",
        stretch, density, 0.4 * stretch, bending);
}

std::string stiffness_name(double stretch) { return fmt::format("1e{} N/m", std::lround(std::log10(stretch))); }

std::string step_name(double step) { return fmt::format("{:.3g} ms", 1000 * step); }

void judge_missed(CaseReport& report, const std::string& name, const MissedSteps& missed)
{
    report.from("the same steps from the same start, solved to the end");
    report.absolute(name + "the most that a step misses, as acceleration over gravity", 0, missed.worst, 0.01);
    // What the program says is an estimate: it may fall short by half of what steps are allowed to leave.
    report.judge(name + "the most that a step misses beyond what the program says", 0, missed.over_bound,
                 std::max(0.0, missed.over_bound), 0.005);
}

namespace {

constexpr double density = 0.3;                             // [kg/m^2]
constexpr double steps_judged[] = {0.005, 0.02, 1.0 / 30};  // [s]

struct Pendulum {
    double side = 0.2, stretch = 1e5, step = 0.02;  // [m], [N/m], [s]
    int resolution = 33;
    bool solved_again = false;

    // Swings bend a sheet the more the longer it is: this much rigidity keeps its part in the period below 0.3 %.
    double bending() const { return 0.005 * std::max(1.0, std::pow(side / 0.2, 3)); }
    bool swings() const { return step < 0.033333; }  // to the other side; otherwise until it hangs
    std::string name() const
    {
        return fmt::format("pendulum of {:g} m, {} a side, {}", side, resolution, step_name(step));
    }
    std::string scene(double until) const
    {
        return fmt::format(
                   "[[sheet]]\nwidth={0}\nheight={0}\nresolution={1}\ncenter=[{2},0,1]\nfabric=\"f\"\n"
                   "[pins]\nsheet=\"left_edge\"\n[contact]\nself=false\n"
                   "[solver]\nuntil={3:.6f}\nstep={4:.17g}\n",
                   side, resolution, 0.5 * side, until, step) +
               motion_fabric(stretch, bending(), density);
    }
};

struct Swing {
    double rigid = 0;       // when a rigid sheet would hang below its edge [s]
    double vertical = 0;    // when this one does [s]
    double amplitude = 0;   // highest angle on the other side [rad]
    double iterations = 0;  // of Newton's method, per step
    int divided = 0;        // steps
    bool refused = false;   // with exit code 3
    MissedSteps missed;
};

// The time at which a rigid sheet hangs that was let go level: a quarter of the period of a pendulum of 90 degrees.
double quarter_period(double length) { return std::comp_ellint_1(std::sqrt(0.5)) * std::sqrt(length / motion_gravity); }

// What stretch adds to it, relatively. At the angle p from the level the sheet carries the tension
// T = density g L sin p (5/2 - x - 3/2 x^2), x = r/L, of its weight and of 3 g sin p / L as the square of its spin. To
// first order in b = density g L / k its longer arm and the energy of stretch make that square 3 g sin p / L
// (1 - 271/60 b sin p); the time is the integral of the inverse of the spin.
double slower_by_stretch(const Pendulum& p)
{
    const double b = density * motion_gravity * p.side / p.stretch;
    // Integrals of sqrt(sin p) and 1/sqrt(sin p) over the quarter.
    const double root = 0.5 * std::beta(0.75, 0.5), inverse = 0.5 * std::beta(0.25, 0.5);
    return 271.0 / 120 * b * root / inverse;
}

// The highest of a motion through three equidistant places.
double peak(double before, double top, double after)
{
    const double slope = 0.5 * (after - before), bend = before - 2 * top + after;
    return bend < 0 ? top - 0.5 * slope * slope / bend : top;
}

// When the center passes below the edge: evenly between the steps that do it. @param start  its x at first [m]
double time_of_hanging(const std::vector<MotionStep>& steps, double start)
{
    double last = start;
    for (const MotionStep& step : steps) {
        const double now = step.center.x();
        if (now <= 0) return step.time - step.dt * now / (now - last);
        last = now;
    }
    return std::numeric_limits<double>::infinity();
}

double highest_angle(const std::vector<MotionStep>& steps)
{
    // From level; the edge is at a height of 1 m.
    const auto turned = [&](std::size_t k) {
        const double angle = std::atan2(1 - steps[k].center.z(), steps[k].center.x());
        return angle < -0.5 * std::numbers::pi ? angle + 2 * std::numbers::pi : angle;
    };
    for (std::size_t k = 1; k + 1 < steps.size(); ++k)
        if (turned(k + 1) < turned(k)) return peak(turned(k - 1), turned(k), turned(k + 1)) - 0.5 * std::numbers::pi;
    return 0;
}

Swing swing_of(const Pendulum& pendulum)
{
    TimedMotion motion(pendulum.scene((pendulum.swings() ? 2.3 : 1.4) * quarter_period(pendulum.side)));
    Swing swing;
    swing.rigid = quarter_period(motion.pendulum_length(Vec3(0, 0, 1)));
    if (pendulum.solved_again) motion.solve_again();
    try {
        const std::vector<MotionStep> steps = motion.run();
        swing.vertical = time_of_hanging(steps, 0.5 * pendulum.side);
        if (pendulum.swings()) swing.amplitude = highest_angle(steps);
        for (const MotionStep& step : steps) {
            swing.iterations += double(step.iterations) / double(steps.size());
            swing.divided += step.divided;
        }
        swing.missed = missed_steps(steps);
    } catch (const StepFailureError&) {
        swing.refused = true;
    }
    return swing;
}

// Adds what is asked of the same pendulum over all stiffnesses.
void compare_stiffnesses(CaseReport& report, const Pendulum& p, const std::vector<Swing>& swings)
{
    const double straight = 0.5 * std::numbers::pi;
    double first = std::numeric_limits<double>::infinity(), last = 0, amplitude = straight, most = 0;
    int divided = 0;
    MissedSteps missed;
    for (std::size_t k = 0; k < swings.size(); ++k) {
        const Swing& s = swings[k];
        if (k > 0) {  // the softest stretches visibly
            first = std::min(first, s.vertical);
            last = std::max(last, s.vertical);
        }
        if (std::abs(s.amplitude - straight) > std::abs(amplitude - straight)) amplitude = s.amplitude;
        most = std::max(most, s.iterations);
        divided += s.divided;
        missed.worst = std::max(missed.worst, s.missed.worst);
        missed.over_bound = std::max(missed.over_bound, s.missed.over_bound);
    }
    if (p.swings()) {
        report.from("what is stiff moves like what is rigid");
        report.judge(p.name() + ", 1e3 to 1e7 N/m: first and last time at which it hangs [s]", first, last,
                     (last - first) / first, 3e-3);
        report.from("conservation of energy");
        report.relative(p.name() + ": the worst height on the other side, as an angle [rad]", straight, amplitude,
                        0.03);
    }
    if (p.solved_again) judge_missed(report, p.name() + ": ", missed);
    if (p.resolution < 33 || p.step != 0.02) return;
    report.from("cost");
    report.judge(p.name() + ": the most Newton iterations per step", 0, most, most, 6);
    report.absolute(p.name() + ": steps that were divided", 0, divided, 0);
}

void pendulum(CaseReport& report, Pendulum p)
{
    const double tolerance = p.step < 0.01 ? 0.005 : p.step < 0.021 ? 0.025 : 0.06;
    std::vector<Swing> swings;
    for (const int exponent : {2, 3, 4, 5, 6, 7}) {
        p.stretch = std::pow(10.0, exponent);
        swings.push_back(swing_of(p));
        const Swing& s = swings.back();
        report.from("K(sin 45) sqrt(l/g), l = sum m r^2 / sum m r; and what stretch adds, to first order");
        const double theory = (1 + slower_by_stretch(p)) * s.rigid;
        const std::string name = fmt::format("{}, {}: ", p.name(), stiffness_name(p.stretch));
        if (s.refused && !p.swings())
            report.judge(name + "refused", theory, theory, 0, tolerance);
        else if (s.refused)
            report.fail(name + "no step succeeds");
        else
            report.relative(name + "hangs after [s]", theory, s.vertical, tolerance);
    }
    compare_stiffnesses(report, p, swings);
}

// Steps end on frames, each 1/30 s: lengths that do not divide it leave a remnant, and a scheme of several steps that
// meets a step after a hundred times shorter one may be unstable.
void uneven_steps(CaseReport& report)
{
    for (const double step : {0.0165, 0.03, 0.033}) {
        const Pendulum p{.step = step, .resolution = 9};
        const Swing s = swing_of(p);
        if (s.refused) {
            report.fail(p.name() + ": no step succeeds");
            continue;
        }
        report.from("K(sin 45) sqrt(l/g), l = sum m r^2 / sum m r");
        report.relative(p.name() + ": hangs after [s]", s.rigid, s.vertical, step < 0.02 ? 0.025 : 0.06);
        report.from("conservation of energy");
        report.relative(p.name() + ": height on the other side, as an angle [rad]", 0.5 * std::numbers::pi, s.amplitude,
                        0.03);
    }
}

}  // namespace

void check_motion(CaseReport& report)
{
    for (const double side : {0.1, 0.2, 0.5})
        for (const int resolution : {9, 33})
            for (const double step : steps_judged)
                if (!report.quick() || (side == 0.2 && step == 0.02))
                    pendulum(report, {.side = side,
                                      .step = step,
                                      .resolution = resolution,
                                      .solved_again = side == 0.2 && !(report.quick() && resolution == 33)});
    uneven_steps(report);
    rigid_fall(report);
    rigid_spin(report);
    leaning_card(report);
}

}  // namespace selvage
