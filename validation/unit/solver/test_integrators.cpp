#include <cmath>

#include "host/model/cloth_model.hpp"
#include "host/solver/state/vectors.hpp"
#include "host/solver/stepping/stability.hpp"
#include "host/solver/stepping/step_control.hpp"
#include "io/errors.hpp"
#include "validation/measure/small_cloth.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

NewtonOptions exact()
{
    NewtonOptions newton;
    newton.max_iterations = 50;
    newton.tolerance = 1e-11;
    newton.linear_tolerance = 1e-8;
    return newton;
}

// A soft sheet; its members are public so that each test can set them.
struct Sheet {
    ClothModel model;
    PhaseOptions options;
    Profile profile;
    std::vector<Vec3> velocities;

    explicit Sheet(int side = 4)
    {
        model.cloth = grid_cloth(side, side, 0.05);
        model.fabrics = test_fabrics();
        Fabric& fabric = model.fabrics.at("test");
        fabric.areal_density = 0.2;
        fabric.stretch_weft = fabric.stretch_warp = 20;
        fabric.shear = 5;
        fabric.bending_weft = fabric.bending_warp = 1e-5;
        fabric.damping = 0;
        options.params.gravity.acceleration_z = -9.81;
        options.params.membrane.scale = options.params.bending.scale = 1;
    }
    Phase phase() { return Phase(model, options, nullptr, profile, model.cloth.positions, velocities); }
};

// A sheet that hangs from two corners and swings; its motion is smooth from the start.
Sheet swinging(double damping)
{
    Sheet sheet;
    sheet.model.cloth.pinned = {12, 15};
    sheet.model.fabrics.at("test").damping = damping;
    sheet.options.params.damping.scale = damping > 0 ? 1 : 0;
    for (Vec3& x : sheet.model.cloth.positions) x = Vec3(x.x(), x.y() * 0.99, -0.1 * (0.15 - x.y()));
    return sheet;
}

std::vector<real> run(Phase& phase, std::string_view name, double until, int steps)
{
    const auto integrator = make_integrator(name, phase);
    for (int k = 0; k < steps; ++k) integrator->step(until / steps, exact());
    return phase.state().pos;
}

constexpr double swing_time = 0.1;  // [s]

std::vector<real> swing(std::string_view name, double damping, int steps)
{
    Sheet sheet = swinging(damping);
    Phase phase = sheet.phase();
    return run(phase, name, swing_time, steps);
}

double observed_order(std::string_view name, double damping, int steps, const std::vector<real>& truth)
{
    Sheet sheet = swinging(damping);
    const Phase shape = sheet.phase();
    const double coarse = largest_distance(shape.state(), swing(name, damping, steps), truth);
    const double fine = largest_distance(shape.state(), swing(name, damping, 2 * steps), truth);
    INFO(name << ": errors " << coarse << " and " << fine);
    CHECK(fine > 1e-12);  // below this the error would be that of rounding
    return std::log2(coarse / fine);
}

Vec3 momentum(const State& s)
{
    Vec3 sum = Vec3::Zero();
    for (int v = 0; v < s.size.vertex_count; ++v) sum += s.mass[v] * vertex_planes(s.size, s.vel)(v);
    return sum;
}

double total_energy(Phase& phase) { return phase.system().potential_energy() + phase.system().kinetic_energy(); }

// A single degree of freedom: the middle of three rows is free and swings out of the plane of a prestressed strip.
struct Oscillator {
    Sheet sheet{3};
    double frequency = 0;  // [rad/s]

    Oscillator()
    {
        sheet.options.params.gravity = {};
        sheet.options.params.bending.scale = 0;
        for (int v = 0; v < 9; ++v)
            if (v != 4) sheet.model.cloth.pinned.push_back(v);
        for (Vec3& x : sheet.model.cloth.positions) x *= 1.1;
        Phase phase = sheet.phase();
        phase.system().evaluate_stiffness(false, 0);
        phase.linear().assemble(phase.state(), 0, MatrixUse::products);
        std::vector<real> up(phase.state().pos.size(), 0.0), force(up);
        const int z = 2 * phase.state().size.vertex_stride + 4;
        up[z] = 1;
        phase.linear().multiply(up.data(), force.data());
        frequency = std::sqrt(force[z] * phase.state().inv_mass[4]);
    }
    // Lifts the vertex by so little that its motion is linear.
    void lift(Phase& phase) const { phase.state().pos[2 * phase.state().size.vertex_stride + 4] = 1e-7; }
    double height(const Phase& phase) const { return phase.state().pos[2 * phase.state().size.vertex_stride + 4]; }
    double speed(const Phase& phase) const { return phase.state().vel[2 * phase.state().size.vertex_stride + 4]; }
};

bool stays_bounded(std::string_view name, double dt, double damping)
{
    Sheet sheet;
    sheet.options.params.gravity = {};
    sheet.model.fabrics.at("test").damping = damping;
    sheet.options.params.damping.scale = damping > 0 ? 1 : 0;
    for (int v = 0; v < 16; ++v)
        sheet.model.cloth.positions[v] += 1e-9 * Vec3(std::sin(v), std::cos(2 * v), std::sin(3 * v));
    Phase phase = sheet.phase();
    const std::vector<real> start = phase.state().pos;
    const auto integrator = make_integrator(name, phase);
    for (int step = 0; step < 3000; ++step) {
        integrator->step(dt, {});
        if (!is_finite(phase.state()) || largest_distance(phase.state(), phase.state().pos, start) > 1e-5) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("every integrator has the order of convergence that it claims, with drag and without")
{
    for (double damping : {0.0, 8.0}) {
        const std::vector<real> truth = swing("rk4", damping, 3200);
        for (const IntegratorInfo& info : integrators()) {
            if (info.order == 0) continue;
            const int steps = info.name == "rk4" ? 200 : info.is_explicit ? 100 : 400;
            INFO(info.name);
            CHECK(observed_order(info.name, damping, steps, truth) == Approx(info.order).margin(0.15));
        }
    }
}

TEST_CASE("schemes of second order and more follow free fall exactly, the others have their known error")
{
    const double dt = 0.01, g = 9.81;
    const int steps = 20;
    const double exact_fall = -g / 2 * std::pow(dt * steps, 2), half_step = g / 2 * dt * dt * steps;
    for (const IntegratorInfo& info : integrators()) {
        if (info.order == 0) continue;
        Sheet sheet;
        sheet.options.params.membrane.scale = sheet.options.params.bending.scale = 0;
        Phase phase = sheet.phase();
        run(phase, info.name, dt * steps, steps);
        const double expected = info.order > 1 ? exact_fall : exact_fall - half_step;
        INFO(info.name);
        for (int v = 0; v < phase.state().size.vertex_count; ++v)
            CHECK(phase.state().pos[2 * phase.state().size.vertex_stride + v] == Approx(expected).epsilon(1e-9));
    }
}

TEST_CASE("implicit Euler shrinks a mode by 1 / sqrt(1 + w^2 dt^2) a step and the midpoint rule keeps it")
{
    Oscillator oscillator;
    const double w = oscillator.frequency, dt = 0.5 / w;
    for (std::string_view name : {"implicit_euler", "implicit_midpoint"}) {
        Phase phase = oscillator.sheet.phase();
        oscillator.lift(phase);
        const auto amplitude = [&] { return std::hypot(oscillator.height(phase), oscillator.speed(phase) / w); };
        const double before = amplitude();
        const auto integrator = make_integrator(name, phase);
        NewtonOptions newton = exact();
        newton.tolerance = 1e-14;
        for (int step = 0; step < 10; ++step) integrator->step(dt, newton);
        const double factor = name == "implicit_euler" ? 1 / std::sqrt(1 + w * w * dt * dt) : 1;
        CHECK(std::pow(amplitude() / before, 0.1) == Approx(factor).epsilon(1e-4));
    }
}

TEST_CASE("the energy of Verlet's scheme oscillates but does not drift")
{
    Sheet sheet = swinging(0);
    Phase phase = sheet.phase();
    const auto integrator = make_integrator("velocity_verlet", phase);
    const double dt = 0.3 * integrator->stable_step(), start = total_energy(phase);
    double early = 0, late = 0, kinetic = 0;
    for (int step = 0; step < 20000; ++step) {
        integrator->step(dt, {});
        const double error = std::abs(total_energy(phase) - start);
        kinetic = std::max(kinetic, phase.system().kinetic_energy());
        double& most = step < 10000 ? early : late;
        most = std::max(most, error);
    }
    // Of a mode w the scheme keeps v^2/2 + w^2 x^2 (1 - (w dt)^2/4)/2, so the energy strays by up to (w dt)^2/4 of it;
    // w dt is 2 at the stability limit.
    CHECK(early < std::pow(0.3 * 2, 2) / 4 * kinetic);
    CHECK(late < 1.5 * early);
}

TEST_CASE("the predicted stability limit is the step at which an explicit scheme becomes unstable")
{
    for (double damping : {0.0, 100.0})
        for (const IntegratorInfo& info : integrators()) {
            if (!info.is_explicit) continue;
            Sheet sheet;
            sheet.model.fabrics.at("test").damping = damping;
            sheet.options.params.damping.scale = damping > 0 ? 1 : 0;
            Phase phase = sheet.phase();
            const double limit = make_integrator(info.name, phase)->stable_step();
            double low = 0.5 * limit, high = 2 * limit;
            CHECK(stays_bounded(info.name, low, damping));
            CHECK_FALSE(stays_bounded(info.name, high, damping));
            for (int halving = 0; halving < 6; ++halving) {
                const double middle = 0.5 * (low + high);
                (stays_bounded(info.name, middle, damping) ? low : high) = middle;
            }
            INFO(info.name << " with damping " << damping << ": predicted " << limit << ", measured " << low);
            CHECK(low == Approx(limit).epsilon(0.1));
            CHECK(limit <= 1.02 * high);
        }
}

TEST_CASE("without gravity and pins every integrator keeps the momentum")
{
    for (const IntegratorInfo& info : integrators()) {
        if (info.order == 0) continue;
        Sheet sheet;
        sheet.options.params.gravity = {};
        for (int v = 0; v < 16; ++v)
            sheet.velocities.push_back(Vec3(0.3 * std::sin(v), 0.5 - 0.02 * v, 0.4 * std::cos(v)));
        Phase phase = sheet.phase();
        const Vec3 before = momentum(phase.state());
        run(phase, info.name, 0.1, 100);
        INFO(info.name);
        CHECK((momentum(phase.state()) - before).norm() < 1e-8 * before.norm());
    }
}

TEST_CASE("a step repeated from a saved state and history gives the same bits")
{
    for (const IntegratorInfo& info : integrators()) {
        Sheet sheet = swinging(1);
        Phase phase = sheet.phase();
        const auto integrator = make_integrator(info.name, phase);
        for (int step = 0; step < 3; ++step) integrator->step(1e-3, exact());
        const std::vector<real> pos = phase.state().pos, vel = phase.state().vel;
        std::vector<std::vector<real>> history;
        for (const HistoryArray& array : integrator->history()) history.push_back(*array.values);
        for (int step = 0; step < 2; ++step) integrator->step(1e-3, exact());
        const std::vector<real> expected = phase.state().pos;
        Phase other = sheet.phase();
        const auto again = make_integrator(info.name, other);
        other.state().pos = pos;
        other.state().vel = vel;
        for (std::size_t k = 0; k < history.size(); ++k) {
            REQUIRE(again->history()[k].values->size() == history[k].size());
            *again->history()[k].values = history[k];
        }
        for (int step = 0; step < 2; ++step) again->step(1e-3, exact());
        INFO(info.name);
        CHECK((other.state().pos == expected));
    }
}

TEST_CASE("pinned vertices do not move by a single bit with any integrator")
{
    for (const IntegratorInfo& info : integrators()) {
        Sheet sheet = swinging(1);
        Phase phase = sheet.phase();
        const std::vector<Vec3> before = phase.positions();
        run(phase, info.name, 0.05, 50);
        const std::vector<Vec3> after = phase.positions();
        INFO(info.name);
        CHECK((after[12] - before[12]).norm() == 0);
        CHECK((after[0] - before[0]).norm() > 1e-4);
    }
}

TEST_CASE("a step above the stability limit is divided, or refused if the options say so")
{
    Sheet sheet = swinging(0);
    Phase phase = sheet.phase();
    const auto integrator = make_integrator("velocity_verlet", phase);
    StepOptions options;
    options.longest = 10 * integrator->stable_step();
    StepControl control(phase, *integrator, options);
    CHECK(control.advance(1, {}, true) == options.longest);
    CHECK(control.shortest() <= 0.9 * control.stable_step());
    CHECK(is_finite(phase.state()));
    options.unstable = UnstableStep::refuse;
    StepControl strict(phase, *integrator, options);
    CHECK_THROWS_AS(strict.advance(1, {}, true), UnstableStepError);
}

TEST_CASE("central differences stay stable with steps whose length keeps changing")
{
    Sheet sheet = swinging(0);
    Phase phase = sheet.phase();
    const auto integrator = make_integrator("central_difference", phase);
    const double dt = 0.5 * integrator->stable_step(), start = total_energy(phase);
    double kinetic = 0, error = 0;
    for (int step = 0; step < 3000; ++step) {
        integrator->step(step / 5 % 2 ? dt : 0.9 * dt, {});
        kinetic = std::max(kinetic, phase.system().kinetic_energy());
        error = std::max(error, std::abs(total_energy(phase) - start));
    }
    CHECK(error < 0.5 * kinetic);
}

TEST_CASE("adaptive steps keep the estimated error below the given one and are not needlessly short")
{
    for (const IntegratorInfo& info : integrators()) {
        if (!info.has_error_estimate()) continue;
        Sheet sheet = swinging(0);
        Phase phase = sheet.phase();
        const auto integrator = make_integrator(info.name, phase);
        StepOptions options;
        options.adaptive = true;
        options.error = 1e-6;
        NewtonOptions newton = exact();
        newton.tolerance = 1e-6;  // with short steps rounding prevents smaller residuals
        StepControl control(phase, *integrator, options);
        double time = 0, shortest = 1, longest = 0;
        while (time < 0.05) {
            time += control.advance(0.05 - time + 1e-12, newton, true);
            CHECK(integrator->error_estimate() <= options.error);
            shortest = std::min(shortest, control.shortest());
            longest = std::max(longest, control.shortest());
        }
        INFO(info.name << ": " << shortest << " to " << longest);
        CHECK(shortest < 0.02);
        CHECK(shortest > 1e-5);
    }
}

TEST_CASE("an unknown integrator is refused with the nearest name")
{
    Sheet sheet;
    Phase phase = sheet.phase();
    CHECK_THROWS_WITH(make_integrator("rk5", phase), contains_text("rk4"));
}
