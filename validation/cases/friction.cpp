// Coulomb friction against closed forms: a patch on an incline, friction_incline.csv, and a strip that slides around a
// cylinder, friction_capstan.csv.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "host/model/body.hpp"
#include "host/model/cloth_model.hpp"
#include "host/solver/state/planes.hpp"
#include "host/solver/stepping/integrator.hpp"
#include "host/solver/stepping/phase.hpp"
#include "host/solver/stepping/step_control.hpp"
#include "kernels/barrier.h"
#include "validation/cases/cases.hpp"
#include "validation/measure/reference.hpp"
#include "validation/measure/specimen.hpp"

namespace selvage {
namespace {

constexpr double gravity = 9.81, areal_density = 0.2, degree = std::numbers::pi / 180;

// A cloth of the specimen's fabric and the body on which it slides.
struct Contact {
    ClothModel model;
    PhaseOptions options;

    Contact(Cloth cloth, Body body, double friction)
    {
        model.cloth = std::move(cloth);
        model.fabrics[specimen_fabric] = isotropic_fabric(1000, 1e-5, 0, areal_density);
        body.friction = friction;
        model.bodies = {std::move(body)};
        options.params.membrane.scale = 1;
        options.params.body_contact.stiffness = 100 * areal_density * gravity;
        options.params.friction.scale = 1;
        options.linear.max_iterations = 2000;
    }
};

// Returns the gap at which the barrier balances a pressure [m].
double resting_gap(const Params& params, double pressure)
{
    double low = 0.02, high = 1;  // of the contact gap
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (-params.body_contact.stiffness * barrier_at(middle).slope > pressure ? low : high) = middle;
    }
    return low * params.body_contact.gap;
}

double mean_of(const State& state, const std::vector<real>& plane)
{
    double sum = 0;
    for (int v = 0; v < state.size.vertex_count; ++v) sum += plane[v];
    return sum / state.size.vertex_count;
}

struct Slide {
    double acceleration = 0;  // [m/s^2]
    double creep = 0;         // [m/s]
};

// Returns means over the second half of a run of 1 s. Gravity is tilted instead of the plane, so that the patch slides
// towards +x.
Slide slide_down(double angle, double friction, const char* scheme)
{
    Body plane;
    plane.kind = Body::Kind::plane;
    Contact contact(flat_rectangle(MeshFamily::alternating, 0.1, 0.1, 5), plane, friction);
    Params& params = contact.options.params;
    params.gravity.acceleration_x = gravity * std::sin(angle);
    params.gravity.acceleration_z = -gravity * std::cos(angle);
    const double gap = resting_gap(params, areal_density * gravity * std::cos(angle));
    for (Vec3& x : contact.model.cloth.positions) x.z() = gap;
    BodyQuery query(contact.model.bodies, Box(Vec3(-1, -1, -1), Vec3(5, 1, 1)));
    Profile profile;
    Phase phase(contact.model, contact.options, &query, profile, contact.model.cloth.positions, {});
    const auto integrator = make_integrator(scheme, phase);
    constexpr double dt = 0.01;
    StepControl control(phase, *integrator, {.longest = dt});
    NewtonOptions newton;
    newton.max_iterations = 40;
    newton.tolerance = 1e-8;
    newton.linear_tolerance = 1e-3;
    Slide slide;
    for (int step = 1; step <= 100; ++step) {
        for (double left = dt; left > 1e-9;) left -= control.advance(left, newton, true);
        if (step != 50) continue;
        slide.acceleration = -mean_of(phase.state(), phase.state().vel);
        slide.creep = -mean_of(phase.state(), phase.state().pos);
    }
    slide.acceleration = 2 * (slide.acceleration + mean_of(phase.state(), phase.state().vel));
    slide.creep = 2 * (slide.creep + mean_of(phase.state(), phase.state().pos));
    return slide;
}

void check_incline(CaseReport& report, const char* scheme)
{
    report.from("friction_incline.csv: a = g (sin theta - mu cos theta), or rest");
    for (const ReferenceRow& row : reference_table("friction_incline.csv")) {
        const double angle = row.number("theta_deg"), friction = row.number("mu");
        const Slide slide = slide_down(angle * degree, friction, scheme);
        const std::string name = fmt::format("incline of {:g} degrees, mu {:g}, {}", angle, friction, scheme);
        if (row.text("state") == "slip")
            report.relative(name + ": acceleration [m/s^2]", row.number("accel"), slide.acceleration, 0.01);
        else
            report.absolute(name + ": creep [m/s]", 0, slide.creep, 1e-4);
    }
}

constexpr double radius = 0.1, width = 0.01, arc_step = 3 * degree, lead = 0.25,
                 pull_speed = 0.02;  // [m], [rad], [m/s]

// A strip wrapped by an angle around the cylinder along y, continued by a straight piece at both ends. It is stretched
// by the given strain.
Cloth wrapped_strip(double wrap, double strain, double gap)
{
    const double r = radius + gap, arc = r * wrap, step = r * arc_step;
    const int columns = int(std::lround((arc + 2 * lead) / step)) + 1;
    Cloth cloth;
    for (const double y : {-0.5 * width, 0.5 * width})
        for (int i = 0; i < columns; ++i) {
            const double s = (arc + 2 * lead) * i / (columns - 1) - lead;  // 0 where the wrap begins
            const double on_arc = std::clamp(s, 0.0, arc), angle = on_arc / r, beyond = s - on_arc;
            const Vec3 radial(std::sin(angle), 0, std::cos(angle)), along(std::cos(angle), 0, -std::sin(angle));
            cloth.positions.push_back(r * radial + beyond * along + Vec3(0, y, 0));
            cloth.panel_coordinates.emplace_back(s / (1 + strain), y);
        }
    for (int i = 0; i + 1 < columns; ++i) {
        cloth.faces.push_back({i, i + 1, columns + i + 1});
        cloth.faces.push_back({i, columns + i + 1, columns + i});
    }
    const Vec3 out(std::cos(wrap), 0, -std::sin(wrap));
    const std::vector<int> first{0, columns}, last{columns - 1, 2 * columns - 1};
    cloth.pinned = {0, columns - 1, columns, 2 * columns - 1};
    cloth.pin_motions = {{first, 0, 10, pull_speed * Vec3(1, 0, 0)}, {last, 0, 10, pull_speed * out}};
    cloth.panels = {one_panel(cloth)};
    return cloth;
}

double pull_on(const State& state, int v, int w)
{
    const ConstPlanes force = vertex_planes(state.size, state.force);
    return (force(v) + force(w)).norm();
}

// Returns the ratio of the tensions at the two ends of the sliding strip, averaged over the time in which it moves by
// one edge length.
double capstan_ratio(double wrap, double friction)
{
    Body cylinder;
    cylinder.kind = Body::Kind::capsule;
    cylinder.center = Vec3(0, -1, 0);
    cylinder.end = Vec3(0, 1, 0);
    cylinder.radius = radius;
    constexpr double strain = 5e-3;
    Contact contact(wrapped_strip(wrap, strain, 1e-3), cylinder, friction);
    BodyQuery query(contact.model.bodies, Box(Vec3(-1, -1, -1), Vec3(1, 1, 1)));
    Profile profile;
    Phase phase(contact.model, contact.options, &query, profile, contact.model.cloth.positions, {});
    const auto integrator = make_integrator("implicit_euler", phase);
    constexpr double dt = 0.01;
    StepControl control(phase, *integrator, {.longest = dt, .moves_boundary = true});
    NewtonOptions newton;
    newton.max_iterations = 60;
    newton.tolerance = 1e-4;
    newton.linear_tolerance = 1e-3;
    const int columns = phase.state().size.vertex_count / 2;
    const int steps_per_edge = int(std::lround(radius * arc_step / (pull_speed * dt)));
    constexpr int edges_before = 5;
    double slack_side = 0, tight_side = 0;
    for (int step = 0; step < (edges_before + 1) * steps_per_edge; ++step) {
        for (double left = dt; left > 1e-9;) left -= control.advance(left, newton, true);
        if (step < edges_before * steps_per_edge) continue;
        phase.system().evaluate_forces(false);
        slack_side += pull_on(phase.state(), 0, columns);
        tight_side += pull_on(phase.state(), columns - 1, 2 * columns - 1);
    }
    return tight_side / slack_side;
}

// The largest ratio of tensions that is judged [1]. At a ratio of 500 the tension of the slack side is as small as the
// residual that the steps leave.
constexpr double measurable = 100;

void check_capstan(CaseReport& report)
{
    report.from("friction_capstan.csv: T2 / T1 = exp(mu phi)");
    for (const ReferenceRow& row : reference_table("friction_capstan.csv")) {
        const double angle = row.number("phi_deg"), friction = row.number("mu");
        const std::string name = fmt::format("strip around {:g} degrees, mu {:g}: tension ratio", angle, friction);
        const double measured = capstan_ratio(angle * degree, friction);
        if (row.number("ratio") < measurable)
            report.relative(name, row.number("ratio"), measured, 0.02);
        else
            report.inform(name, row.number("ratio"), measured);
    }
}

}  // namespace

void check_friction(CaseReport& report)
{
    check_incline(report, "implicit_euler");
    check_incline(report, "bdf2");
    check_capstan(report);
}

}  // namespace selvage
