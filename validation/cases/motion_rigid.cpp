// Free bodies: what a scheme makes of a rigid body is known exactly, and cloth that nothing strains is one.
#include <cmath>
#include <complex>
#include <vector>

#include <fmt/format.h>

#include "host/solver/stepping/step_failure.hpp"
#include "validation/cases/motion.hpp"

namespace selvage {
namespace {

constexpr double step_length = 0.02;  // at most: steps end on frames [s]

// Falling ---------------------------------------------------------------------------------------------------------

struct FallingSheet {
    std::string name;
    double side = 1;  // [m]
    int resolution = 17;
    double stretch = 1e3, density = 0.15;  // [N/m], [kg/m^2]
};

// How far a scheme lets a body fall that starts at rest.
double way_of_fall(const std::string& integrator, const std::vector<MotionStep>& steps)
{
    double way = 0, speed = 0;
    for (const MotionStep& step : steps) {
        const double before = speed;
        speed += motion_gravity * step.dt;
        way += step.dt * (integrator == "implicit_euler" ? speed : 0.5 * (before + speed));
    }
    return way;
}

std::string fall_scene(const FallingSheet& sheet, const std::string& integrator, const std::string& precision)
{
    return fmt::format(
               "[[sheet]]\nwidth={0}\nheight={0}\nresolution={1}\nmesh_family=\"irregular\"\n"
               "rotation=[30,20,10]\ncenter=[3,5,50]\nfabric=\"f\"\n[contact]\nself=false\n"
               "[solver]\nuntil=1\nintegrator=\"{2}\"\nprecision=\"{3}\"\nstep={4}\n",
               sheet.side, sheet.resolution, integrator, precision, step_length) +
           motion_fabric(sheet.stretch, 1e-5, sheet.density);
}

// @param flat  without the ripple of sheets that start level: nothing then is left to iterate for
void fall(CaseReport& report, const FallingSheet& sheet, const std::string& integrator, const std::string& precision,
          bool flat)
{
    TimedMotion motion(fall_scene(sheet, integrator, precision));
    if (flat) motion.start_at([](const Vec2& x) { return Vec3(3 + 0.8 * x.x(), 5 + x.y(), 50 + 0.6 * x.x()); });
    const std::string name =
        fmt::format("{}{} falls 1 s, {}, {}: ", flat ? "flat " : "", sheet.name, integrator, precision);
    if (!flat) motion.solve_again();
    const Vec3 start = motion.center();
    try {
        const std::vector<MotionStep> steps = motion.run();
        const Vec3 way = steps.back().center - start;
        report.from("the sum that the scheme makes of a body in free fall");
        report.relative(name + "way [m]", way_of_fall(integrator, steps), -way.z(), 1e-4);
        report.absolute(name + "aside [m]", 0, std::hypot(way.x(), way.y()), 1e-4);
        int iterations = 0;
        for (std::size_t k = 1; k < steps.size(); ++k) iterations += steps[k].iterations;
        if (flat) report.absolute(name + "Newton iterations after the first step", 0, iterations, 0);
        if (flat) return;
        judge_missed(report, name, missed_steps(steps));
    } catch (const StepFailureError& error) {
        report.fail(name + error.what());
    }
}

// Spinning --------------------------------------------------------------------------------------------------------

constexpr double spin = 6, spin_time = 0.5;  // [rad/s], [s]

// What implicit Euler makes of a body that turns in a plane: its shape times a complex number of modulus 1. Forces of
// constraint pull each step's end from where the body would fly to the nearest place.
struct EulerTurn {
    std::complex<double> place = 1, speed = {0, spin};  // [1], [1/s]
    double angle = 0;                                   // [rad]

    double energy() const { return std::norm(speed) / (spin * spin); }  // over that at the start

    void take(double dt)
    {
        const std::complex<double> before = place, target = before + dt * speed;
        place = target / std::abs(target);
        speed = (place - before) / dt;
        angle += std::arg(place / before);
    }
};

// The angle by which the sheet has turned since its first place: that of the best rotation about its center.
double angle_between(const std::vector<Vec3>& first, const std::vector<Vec3>& now)
{
    Vec3 a = Vec3::Zero(), b = Vec3::Zero();
    for (std::size_t v = 0; v < now.size(); ++v) {
        a += first[v] / double(now.size());
        b += now[v] / double(now.size());
    }
    std::complex<double> sum = 0;
    for (std::size_t v = 0; v < now.size(); ++v) {
        const Vec3 p = first[v] - a, q = now[v] - b;
        sum += std::complex(q.x(), q.y()) * std::conj(std::complex(p.x(), p.y()));
    }
    return std::arg(sum);
}

struct Spin {
    double angle = 0;                              // [rad]
    double kinetic = 0, energy = 0, momentum = 0;  // over those at the start; energy: with that of stretch [1]
    double drift = 0;                              // of the center [m]
    std::vector<MotionStep> steps;
};

Spin spin_of(TimedMotion& motion)
{
    const Vec3 center = motion.center();
    motion.start_with([&](const Vec3& place) { return Vec3(0, 0, spin).cross(place - center).eval(); });
    motion.solve_again();
    const double energy = motion.kinetic_energy(), momentum = motion.angular_momentum().z();
    Spin result;
    std::vector<Vec3> last = motion.phase().positions();
    result.steps = motion.run([&](const MotionStep&) {
        const std::vector<Vec3> now = motion.phase().positions();
        result.angle += angle_between(last, now);
        last = now;
        return true;
    });
    result.kinetic = motion.kinetic_energy() / energy;
    result.energy = result.kinetic + motion.phase().system().potential_energy() / energy;
    result.momentum = motion.angular_momentum().z() / momentum;
    result.drift = (result.steps.back().center - center).norm();
    return result;
}

void judge_spin(CaseReport& report, const std::string& name, const std::string& integrator, const Spin& s)
{
    if (integrator == "bdf2") {
        report.from("a rigid body in free rotation");
        report.relative(name + "angle [rad]", spin * spin_time, s.angle, 0.005);
        report.relative(name + "kinetic energy over the first", 1, s.kinetic, 0.02);
    } else if (integrator == "implicit_euler") {
        EulerTurn theory;
        for (const MotionStep& step : s.steps) theory.take(step.dt);
        report.from("what implicit Euler makes of a rigid body in free rotation");
        report.relative(name + "angle [rad]", theory.angle, s.angle, 0.005);
        report.relative(name + "kinetic energy over the first", theory.energy(), s.kinetic, 0.02);
    } else {
        // It keeps what is quadratic. Ends of its steps are stretched, and this stretch swings on for ever.
        double angle = 0;
        for (const MotionStep& step : s.steps) angle += 2 * std::atan(0.5 * spin * step.dt);
        report.from("what the midpoint rule makes of a rigid body in free rotation");
        report.relative(name + "angle [rad]", angle, s.angle, 0.005);
        report.relative(name + "angular momentum over the first", 1, s.momentum, 1e-3);
        report.from("steps that gain more than a quarter of the energy are refused");
        report.judge(name + "energy over the first", 1, s.energy, std::max(0.0, s.energy - 1), 0.25);
    }
    report.from("a center that stays");
    report.absolute(name + "drift of its center [m]", 0, s.drift, 1e-4);
    judge_missed(report, name, missed_steps(s.steps));
}

void spinning(CaseReport& report, const std::string& integrator, double stretch)
{
    TimedMotion motion(fmt::format("[[sheet]]\nwidth=0.2\nheight=0.2\nresolution=33\nfabric=\"f\"\n"
                                   "[contact]\nself=false\n"
                                   "[solver]\nuntil={}\nintegrator=\"{}\"\nstep={}\ngravity=[0,0,0]\n",
                                   spin_time, integrator, step_length) +
                       motion_fabric(stretch, 0.005, 0.3));
    const std::string name = fmt::format("level sheet of {} spins 3 rad, {}: ", stiffness_name(stretch), integrator);
    try {
        judge_spin(report, name, integrator, spin_of(motion));
    } catch (const StepFailureError& error) {
        if (integrator == "implicit_midpoint")
            report.judge(name + "refused", 0, 0, 0, 0);
        else
            report.fail(name + error.what());
    }
}

}  // namespace

void rigid_fall(CaseReport& report)
{
    const std::vector<FallingSheet> sheets = {{"sheet of 4 m", 4, 17, 1e3, 0.15},
                                              {"sheet of 0.2 m", 0.2, 17, 1e5, 0.3},
                                              {"stiff light sheet of 4 m", 4, 17, 1e6, 0.005},
                                              {"finer stiff light sheet of 4 m", 4, 33, 1e6, 0.005}};
    std::vector<std::string> precisions = {"float"};
    if (!report.quick()) precisions.push_back("double");
    for (const FallingSheet& sheet : sheets) {
        if (report.quick() && sheet.resolution == 33) continue;
        for (const char* integrator : {"bdf2", "implicit_euler", "implicit_midpoint"})
            for (const std::string& precision : precisions)
                for (const bool flat : {false, true}) fall(report, sheet, integrator, precision, flat);
    }
}

void rigid_spin(CaseReport& report)
{
    for (const char* integrator : {"bdf2", "implicit_euler"}) spinning(report, integrator, 1e6);
    if (report.quick()) return;
    for (const char* integrator : {"bdf2", "implicit_euler", "implicit_midpoint"}) spinning(report, integrator, 1e4);
    spinning(report, "implicit_midpoint", 1e6);
}

}  // namespace selvage
