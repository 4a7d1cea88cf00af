#include <cmath>
#include <numbers>

#include "host/garment/pins.hpp"
#include "host/garment/sheet.hpp"
#include "host/model/body.hpp"
#include "host/model/cloth_model.hpp"
#include "host/solver/stepping/equilibrium.hpp"
#include "host/solver/stepping/phase.hpp"
#include "io/scene/fabric_table.hpp"
#include "validation/measure/small_cloth.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

const Box everywhere(Vec3::Constant(-10), Vec3::Constant(10));

ClothModel sheet_model(int resolution, const std::vector<PinMotionScene>& motions = {})
{
    SheetScene sheet;
    sheet.width = sheet.height = 0.2;
    sheet.resolution = resolution;
    sheet.center = Vec3::Zero();
    ClothModel model;
    model.cloth = make_sheet(sheet, "", "sheet[0]");
    for (const PinMotionScene& motion : motions) {
        const PinGroup group = find_word<PinGroup>(word_of(motion.group)).value();
        move_vertices(model.cloth, chosen_vertices(model.cloth, {"", group, ""}, {}), motion);
    }
    model.fabrics["cotton"] = fabric_preset("cotton");
    return model;
}

PhaseOptions options_with(double gravity, bool contact)
{
    PhaseOptions options;
    options.params.gravity.acceleration_z = -gravity;
    options.params.membrane.scale = 1;
    options.params.plate.scale = 1;
    if (contact) options.params.body_contact.stiffness = 200;
    if (contact) options.params.friction.scale = 1;
    return options;
}

Vec3 mean(const std::vector<Vec3>& x)
{
    Vec3 sum = Vec3::Zero();
    for (const Vec3& each : x) sum += each;
    return sum / double(x.size());
}

// A sheet on a plane that moves from 0.1 s to 0.6 s with the given mean speed.
struct Belt {
    ClothModel model = sheet_model(7);
    std::unique_ptr<BodyQuery> query;
    Profile profile;
    std::unique_ptr<Phase> phase;

    Belt(double speed, double friction, bool smooth)
    {
        Body plane;
        plane.kind = Body::Kind::plane;
        plane.friction = friction;
        plane.motion = std::make_shared<BodyMotion>(
            std::vector<MotionKey>{{}, {0.1, Vec3::Zero(), Vec3::Zero()}, {0.6, Vec3(0.5 * speed, 0, 0), Vec3::Zero()}},
            smooth, Vec3::Zero());
        model.bodies = {plane};
        for (Vec3& x : model.cloth.positions) x.z() = 0.0018;
        query = std::make_unique<BodyQuery>(model.bodies, everywhere);
        phase = std::make_unique<Phase>(model, options_with(9.81, true), query.get(), profile, model.cloth.positions,
                                        std::vector<Vec3>{});
    }
    Vec3 ride(double until, DrapeProgress& progress, const char* integrator = "bdf2")
    {
        const auto scheme = make_integrator(integrator, *phase);
        EquilibriumOptions options;
        options.step.longest = 0.01;
        options.integrator = scheme.get();
        options.newton_iterations = 40;
        drape_until(*phase, options, until, 1.0 / 60, progress, [](const StepEvent&) { return true; });
        return mean(phase->positions());
    }
};

}  // namespace

TEST_CASE("a sheet that sticks to a moving plane moves with it")
{
    for (const char* integrator : {"implicit_euler", "bdf2"}) {
        Belt belt(0.2, 0.8, true);  // at most 2.4 m/s^2, so the sheet never slips
        DrapeProgress progress;
        const double start = belt.ride(0.1, progress, integrator).x();
        CHECK(belt.ride(0.6, progress, integrator).x() - start == Approx(0.1).margin(5e-4));
        const double end = belt.ride(0.8, progress, integrator).x();
        CHECK(belt.ride(1.0, progress, integrator).x() - end == Approx(0).margin(1e-5));
    }
}

TEST_CASE("a sheet that slides on a moving plane is driven by Coulomb's force")
{
    Belt belt(5, 0.1, false);  // friction cannot accelerate the sheet to the belt's speed within 0.5 s
    DrapeProgress progress;
    belt.ride(0.3, progress);
    const double before = mean(belt.phase->velocities()).x();
    belt.ride(0.5, progress);
    CHECK((mean(belt.phase->velocities()).x() - before) / 0.2 == Approx(0.1 * 9.81).epsilon(0.01));
}

TEST_CASE("a drape to equilibrium on a moving body ends only after the body has come to rest")
{
    Belt belt(0.2, 0.8, true);  // at most 2.4 m/s^2, so the sheet never slips
    EquilibriumOptions options;
    options.step.longest = 0.01;
    DrapeProgress progress;
    CHECK(drape_to_equilibrium(*belt.phase, options, progress, [](const StepEvent&) { return true; }) ==
          PhaseEnd::reached);
    CHECK(belt.phase->system().clock().time >= 0.6);
    CHECK(belt.query->time() >= 0.6);
    CHECK(mean(belt.phase->positions()).x() == Approx(0.1).margin(1e-3));
}

TEST_CASE("a step that fails leaves bodies and pins where they were")
{
    Belt belt(1, 0.8, false);
    const auto scheme = make_integrator("implicit_euler", *belt.phase);
    belt.phase->system().clock().time = 0.2;
    StepControl control(*belt.phase, *scheme, {.longest = 0.01, .moves_boundary = true});
    NewtonOptions hopeless;
    hopeless.max_iterations = 1;
    hopeless.tolerance = 1e-14;
    belt.phase->state().vel[0] = 3;
    const std::vector<real> before = belt.phase->state().pos;
    CHECK_THROWS_AS(control.advance(0.01, hopeless, true), DivergenceError);
    CHECK(belt.query->time() == 0.2);
    CHECK(belt.phase->state().pos == before);
}

TEST_CASE("held vertices follow their path exactly")
{
    PinMotionScene lift, turn;
    lift.group = MovingPinGroup::left_edge;
    lift.end = 0.4;
    lift.velocity = Vec3(0.1, 0, 0.2);
    turn.group = MovingPinGroup::left_edge;
    turn.start = 0.2;
    turn.end = 0.6;
    turn.turns = 0.5;
    turn.axis = Vec3(2, 0, 0);
    const ClothModel model = sheet_model(9, {lift, turn});
    Profile profile;
    for (const char* integrator : {"implicit_euler", "bdf2"}) {
        Phase phase(model, options_with(9.81, false), nullptr, profile, model.cloth.positions, {});
        const auto scheme = make_integrator(integrator, phase);
        EquilibriumOptions options;
        options.step.longest = 0.02;
        options.integrator = scheme.get();
        options.newton_iterations = 60;
        DrapeProgress progress;
        const auto follow = [&](const StepEvent& event) {
            const double lifted = std::min(event.time, 0.4),
                         angle = std::numbers::pi * std::clamp((event.time - 0.2) / 0.4, 0.0, 1.0);
            const std::vector<Vec3> x = phase.positions();
            for (const int v : model.cloth.pinned) {
                const Vec3 at = model.cloth.positions[v] + lifted * lift.velocity;
                const Vec3 wanted(at.x(), std::cos(angle) * at.y() - std::sin(angle) * at.z(),
                                  std::sin(angle) * at.y() + std::cos(angle) * at.z());
                CHECK((x[v] - wanted).norm() < 1e-12);
            }
            return true;
        };
        CHECK(drape_until(phase, options, 0.8, 0.1, progress, follow) == PhaseEnd::reached);
    }
}
