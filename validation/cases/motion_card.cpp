// A card that leans on a floor without friction and falls over.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "host/solver/state/planes.hpp"
#include "host/solver/stepping/step_failure.hpp"
#include "validation/cases/motion.hpp"
#include "validation/measure/timed_motion.hpp"

namespace selvage {
namespace {

constexpr double width = 0.063, start_angle = 65 * std::numbers::pi / 180;  // [m], from the floor [rad]

std::string card_scene(const std::string& integrator, double step)
{
    return fmt::format(
               "[[sheet]]\nwidth={}\nheight=0.088\nresolution=9\nrotation=[0,-65,0]\ncenter=[0,0,0.0304]\n"
               "fabric=\"f\"\n[[body]]\nname=\"floor\"\nshape=\"plane\"\nfriction=0\n"
               "[solver]\nuntil=0.2\nintegrator=\"{}\"\nstep={}\n",
               width, integrator, step) +
           motion_fabric(1e5, 0.005, 0.3);
}

// When a rod of length 2 a whose foot glides without friction has fallen to half its height: its center falls straight
// down, and by energy (cos^2 p + c) a p'^2 = 2 g (sin p0 - sin p), where c m a^2 is its moment of inertia.
double time_to_half(double a, double c)
{
    const double top = std::sin(start_angle);
    // With p = p0 - u^2 the integrand has no pole.
    const double end = std::sqrt(start_angle - std::asin(0.5 * top));
    constexpr int pieces = 10000;
    double sum = 0;
    for (int k = 0; k < pieces; ++k) {
        const double u = (k + 0.5) / pieces * end, angle = start_angle - u * u, cosine = std::cos(angle);
        sum += 2 * u * std::sqrt((cosine * cosine + c) * a / (2 * motion_gravity * (top - std::sin(angle))));
    }
    return sum * end / pieces;
}

// Moment of inertia about the axis of the fall, over mass and half the width squared.
double inertia_number(const TimedMotion& card)
{
    const State& s = card.phase().state();
    const ConstPlanes x = vertex_planes(s.size, s.pos);
    const Vec3 center = card.center();
    double mass = 0, sum = 0;
    for (int v = 0; v < x.count; ++v) {
        const Vec3 arm = x(v) - center;
        mass += s.mass[v];
        sum += s.mass[v] * (arm.x() * arm.x() + arm.z() * arm.z());
    }
    return sum / (mass * 0.25 * width * width);
}

struct Heights {
    double lowest = std::numeric_limits<double>::infinity(), highest = 0;  // of vertices [m]
};

Heights heights_of(const TimedMotion& card)
{
    const State& s = card.phase().state();
    const ConstPlanes x = vertex_planes(s.size, s.pos);
    Heights h;
    for (int v = 0; v < x.count; ++v) {
        h.lowest = std::min(h.lowest, x(v).z());
        h.highest = std::max(h.highest, x(v).z());
    }
    return h;
}

struct CardFall {
    double half = std::numeric_limits<double>::infinity();  // when it has fallen to half its height [s]
    double aside = 0;                                       // of its center, until it lies [m]
    MissedSteps missed;
};

CardFall fall_of(TimedMotion& card)
{
    card.solve_again();
    const Vec3 start = card.center();
    // Above its foot, which stands on the contact gap.
    const auto height = [&] { return card.center().z() - heights_of(card).lowest; };
    const double half = 0.5 * height();
    double last = 2 * half;
    CardFall fall;
    fall.missed = missed_steps(card.run([&](const MotionStep& step) {
        const double now = height();
        if (now <= half && last > half) fall.half = step.time - step.dt * (half - now) / (last - now);
        last = now;
        fall.aside = std::max(fall.aside, std::hypot(step.center.x() - start.x(), step.center.y() - start.y()));
        return heights_of(card).highest > card.phase().params().body_contact.gap;
    }));
    return fall;
}

}  // namespace

void leaning_card(CaseReport& report)
{
    for (const auto& [step, tolerance] : {std::pair{0.02, 0.1}, {0.005, 0.02}})
        for (const char* integrator : {"automatic", "bdf2"}) {
            TimedMotion card(card_scene(integrator, step));
            const std::string name =
                fmt::format("card that falls over, {}, {}: ", text_of(card.settings().integrator), step_name(step));
            const double theory = time_to_half(0.5 * width, inertia_number(card));
            try {
                const CardFall fall = fall_of(card);
                report.from("energy of a rod whose foot glides, with the inertia of the mesh");
                // Implicit Euler's own error is half a step, whatever is left of its steps: bdf2 is judged.
                if (card.settings().integrator == IntegratorChoice::bdf2)
                    report.relative(name + "at half its height after [s]", theory, fall.half, tolerance);
                else
                    report.inform(name + "at half its height after [s]", theory, fall.half);
                report.absolute(name + "aside until it lies [m]", 0, fall.aside, 5e-4);
                judge_missed(report, name, fall.missed);
            } catch (const StepFailureError& error) {
                report.fail(name + error.what());
            }
        }
}

}  // namespace selvage
