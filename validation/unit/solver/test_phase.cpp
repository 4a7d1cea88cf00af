#include <cmath>

#include "host/model/body.hpp"
#include "host/model/cloth_model.hpp"
#include "host/scene/plan.hpp"
#include "host/solver/state/planes.hpp"
#include "host/solver/stepping/equilibrium.hpp"
#include "host/solver/stepping/phase.hpp"
#include "host/solver/stepping/sewing.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "io/scene/read_scene.hpp"
#include "validation/measure/small_cloth.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

RunPlan plan_of(const std::string& source, const std::vector<std::string>& overrides)
{
    const Scene scene = read_scene(source, overrides);
    return make_plan(scene, build_scene_model(scene));
}

ClothModel grid_model(int side)
{
    ClothModel model;
    model.cloth = grid_cloth(side, side, 0.02);
    model.fabrics = test_fabrics();
    Fabric& fabric = model.fabrics.at("test");
    fabric.areal_density = 0.2;
    fabric.stretch_weft = fabric.stretch_warp = 300;
    fabric.stretch_coupling = 0;
    fabric.shear = 50;
    fabric.bending_weft = fabric.bending_warp = 1e-5;
    fabric.damping = 0;
    return model;
}

Params cloth_params()
{
    Params params;
    params.gravity.acceleration_z = -9.81;
    params.membrane.scale = 1;
    params.bending.scale = 1;
    return params;
}

Vec3 momentum(const Phase& phase)
{
    Vec3 sum = Vec3::Zero();
    const State& s = phase.state();
    for (int v = 0; v < s.size.vertex_count; ++v) sum += s.mass[v] * vertex_planes(s.size, s.vel)(v);
    return sum;
}

Vec3 centre_of_mass(const Phase& phase)
{
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    const State& s = phase.state();
    for (int v = 0; v < s.size.vertex_count; ++v) {
        mass += s.mass[v];
        sum += s.mass[v] * vertex_planes(s.size, s.pos)(v);
    }
    return sum / mass;
}

struct Slide {
    double way = 0;           ///< Distance in the second half of a second [m].
    double acceleration = 0;  ///< Mean after the first 0.2 s, in which the sheet lands [m/s^2].
};

// Lets a sheet slide on a plane that is inclined by `angle` towards +x.
Slide slide_on_incline(double angle, double friction)
{
    ClothModel model = grid_model(7);
    Body plane;
    plane.kind = Body::Kind::plane;
    plane.normal = Vec3::UnitZ();
    plane.friction = friction;
    model.bodies.push_back(plane);
    for (Vec3& x : model.cloth.positions) x.z() = 0.0018;
    BodyQuery query(model.bodies, Box(Vec3(-5, -5, -1), Vec3(5, 5, 1)));
    PhaseOptions options;
    options.params = cloth_params();
    // Gravity is tilted instead of the plane, so that the motion is along x.
    options.params.gravity.acceleration_x = 9.81 * std::sin(angle);
    options.params.gravity.acceleration_z = -9.81 * std::cos(angle);
    options.params.body_contact.stiffness = 200;
    options.params.friction.scale = 1;
    Profile profile;
    Phase phase(model, options, &query, profile, model.cloth.positions, {});
    NewtonOptions newton;
    newton.max_iterations = 30;
    newton.tolerance = 1e-6;
    double mass = 0;
    for (double m : phase.state().mass) mass += m;
    Slide slide;
    for (int step = 1; step <= 100; ++step) {
        implicit_euler_step(phase.newton(), 0.01, newton);
        if (step == 20) slide.acceleration -= momentum(phase).x() / mass / 0.8;
        if (step == 50) slide.way -= centre_of_mass(phase).x();
    }
    slide.acceleration += momentum(phase).x() / mass / 0.8;
    slide.way += centre_of_mass(phase).x();
    return slide;
}

// The halves of a sheet of 6 x 6 vertices without the faces between its two columns in the middle, moved apart and to
// be sewn together again.
struct TwoStrips {
    // @param apart  [m]   @param pinned  vertices
    explicit TwoStrips(double apart, std::vector<int> pinned = {})
    {
        std::erase_if(model.cloth.faces, [](const Face& f) {
            int left = 0;
            for (int v : f) left += v % 6 <= 2;
            return left != 0 && left != 3;
        });
        model.cloth.panels[0].face_count = int(model.cloth.faces.size());
        for (int v = 0; v < 36; ++v)
            if (v % 6 >= 3) model.cloth.positions[v].x() += apart;
        for (int row = 0; row < 6; ++row) model.cloth.seam_pairs.push_back({6 * row + 2, 6 * row + 3});
        model.cloth.pinned = std::move(pinned);
        PhaseOptions& options = sewn.options;
        options.joined = false;
        options.params = cloth_params();
        options.params.gravity = {};
        options.params.seam.stiffness = sewing.first_stiffness = 400;
        options.params.seam.force_limit = sewing.first_limit = 0.02;
        progress.welded = coinciding_pairs(model.cloth);
        remake_phase(sewn, sewing, progress, model.cloth.positions, {}, {});
    }

    PhaseEnd close()
    {
        return close_seams(sewn, sewing, progress, [](const StepEvent&) { return true; });
    }

    ClothModel model = grid_model(6);
    SewingOptions sewing;
    SewingProgress progress;
    Profile profile;
    std::unique_ptr<Phase> phase;
    SewnCloth sewn{model, {}, nullptr, profile, phase};
};

}  // namespace

TEST_CASE("free fall follows the implicit Euler sequence exactly")
{
    const ClothModel model = grid_model(5);
    PhaseOptions options;
    options.params = cloth_params();
    Profile profile;
    Phase phase(model, options, nullptr, profile, model.cloth.positions, {});
    NewtonOptions newton;
    newton.tolerance = 1e-12;
    newton.linear_tolerance = 1e-10;
    const double dt = 0.01;
    for (int step = 1; step <= 20; ++step) implicit_euler_step(phase.newton(), dt, newton);
    const State& s = phase.state();
    for (int v = 0; v < s.size.vertex_count; ++v)
        CHECK(s.pos[2 * s.size.vertex_stride + v] == Approx(-9.81 * dt * dt * 20 * 21 / 2).epsilon(1e-9));
}

TEST_CASE("joining sewn vertices keeps the mass, the centre of mass and the momentum")
{
    ClothModel model = grid_model(4);
    model.cloth.seam_pairs = {{0, 15}, {3, 12}, {1, 2}};
    std::vector<Vec3> positions = model.cloth.positions, velocities;
    for (int v = 0; v < 16; ++v) velocities.push_back(Vec3(0.1 * v, 1 - 0.05 * v, std::sin(v)));
    PhaseOptions apart;
    apart.params = cloth_params();
    apart.joined = false;
    PhaseOptions joined = apart;
    joined.joined = true;
    Profile profile;
    Phase before(model, apart, nullptr, profile, positions, velocities);
    Phase after(model, joined, nullptr, profile, positions, velocities);
    CHECK(before.state().size.vertex_count == 16);
    CHECK(after.state().size.vertex_count == 13);
    CHECK((momentum(before) - momentum(after)).norm() < 1e-15);
    CHECK((centre_of_mass(before) - centre_of_mass(after)).norm() < 1e-14);
    const std::vector<Vec3> now = after.positions();
    CHECK((now[0] - now[15]).norm() == 0);
}

TEST_CASE("sewing closes the gap between two strips")
{
    TwoStrips strips(0.1);
    CHECK(!all_welded(strips.progress.welded));
    CHECK(largest_gap(*strips.phase) == Approx(0.12));
    CHECK(strips.phase->state().size.vertex_count == 36);
    CHECK(strips.close() == PhaseEnd::reached);
    CHECK(all_welded(strips.progress.welded));
    CHECK(strips.phase->state().size.vertex_count == 30);
    CHECK(strips.phase->topology().stitches.empty());
}

TEST_CASE("welding keeps the mass, the centre of mass, the momentum and the time")
{
    ClothModel model = grid_model(4);
    model.cloth.seam_pairs = {{0, 15}, {3, 12}, {1, 2}};
    std::vector<Vec3> velocities;
    for (int v = 0; v < 16; ++v) velocities.push_back(Vec3(0.1 * v, 1 - 0.05 * v, std::sin(v)));
    PhaseOptions options;
    options.params = cloth_params();
    options.joined = false;
    Profile profile;
    std::unique_ptr<Phase> phase;
    SewnCloth sewn{model, options, nullptr, profile, phase};
    SewingProgress progress;
    remake_phase(sewn, {}, progress, model.cloth.positions, velocities, {1.5, 0});
    const Vec3 before = momentum(*phase), centre = centre_of_mass(*phase);
    CHECK(phase->topology().stitches.size() == 3);
    progress.welded = {0, 1, 0};
    remake_phase(sewn, {}, progress, phase->positions(), phase->velocities(), phase->system().clock());
    CHECK(phase->state().size.vertex_count == 15);
    CHECK(phase->topology().stitches.size() == 2);
    CHECK((momentum(*phase) - before).norm() < 1e-15);
    CHECK((centre_of_mass(*phase) - centre).norm() < 1e-14);
    CHECK(phase->system().clock().time == 1.5);
}

TEST_CASE("a seam that cannot close is given up, and what can close is welded")
{
    TwoStrips strips(0.01, {2, 3});
    CHECK(strips.close() == PhaseEnd::time_limit);
    CHECK(strips.progress.welded == std::vector<char>{0, 1, 1, 1, 1, 1});
    CHECK(strips.phase->system().clock().time < strips.sewing.max_time);
}

TEST_CASE("a sheet sticks on an incline below the friction angle and slides at Coulomb's rate above it")
{
    CHECK(std::abs(slide_on_incline(std::atan(0.25), 0.3).way) < 1e-6);
    const double angle = std::atan(0.5);
    CHECK(slide_on_incline(angle, 0.3).acceleration ==
          Approx(9.81 * (std::sin(angle) - 0.3 * std::cos(angle))).epsilon(0.005));
}

TEST_CASE("a hanging sheet comes to rest with its forces balanced and its pins where they were")
{
    ClothModel model = grid_model(9);
    model.cloth.pinned = {72, 80};
    PhaseOptions options;
    options.params = cloth_params();
    options.params.damping.scale = 1;
    Profile profile;
    Phase phase(model, options, nullptr, profile, model.cloth.positions, {});
    DrapeProgress progress;
    CHECK(drape_to_equilibrium(phase, {}, progress, [](const StepEvent&) { return true; }) == PhaseEnd::reached);
    CHECK(phase.system().residual() <= 1e-3);
    const std::vector<Vec3> now = phase.positions();
    for (int pin : {72, 80}) CHECK((now[pin] - model.cloth.positions[pin]).norm() == 0);
    CHECK(now[4].z() < -0.1);
}

TEST_CASE("a phase that starts over moves exactly like one that was made with the new positions")
{
    ClothModel model = grid_model(9);
    model.cloth.pinned = {72, 80};
    std::vector<Vec3> bent = model.cloth.positions;
    for (Vec3& x : bent) x.z() = 0.3 * x.x() * x.x();
    PhaseOptions options;
    options.params = cloth_params();
    Profile profile;
    Phase again(model, options, nullptr, profile, model.cloth.positions, {}),
        fresh(model, options, nullptr, profile, bent, {});
    NewtonOptions newton;
    implicit_euler_step(again.newton(), 0.01, newton);
    again.start_over(model, bent);
    for (Phase* phase : {&again, &fresh})
        for (int step = 0; step < 3; ++step) implicit_euler_step(phase->newton(), 0.01, newton);
    CHECK(again.state().pos == fresh.state().pos);
    CHECK(again.state().vel == fresh.state().vel);
}

TEST_CASE("a stop in the middle of a step leaves the state of the last completed step")
{
    ClothModel model = grid_model(9);
    model.cloth.pinned = {72, 80};
    PhaseOptions options;
    options.params = cloth_params();
    Profile profile;
    Phase phase(model, options, nullptr, profile, model.cloth.positions, {});
    int asked = 0;
    EquilibriumOptions equilibrium;
    equilibrium.stop = [&asked] { return ++asked > 6; };  // in the middle of a step
    std::vector<real> pos, vel;
    DrapeProgress progress;
    double time = 0;
    const auto after_step = [&](const StepEvent& event) {
        pos = phase.state().pos;
        vel = phase.state().vel;
        time = event.time;
        return true;
    };
    REQUIRE(drape_until(phase, equilibrium, 1, 0.02, progress, after_step) == PhaseEnd::stopped);
    CHECK(asked == 7);
    CHECK(time > 0);
    CHECK(phase.system().clock().time == time);
    CHECK(phase.state().pos == pos);
    CHECK(phase.state().vel == vel);
}

TEST_CASE("a plan launches and allocates only what the scene has")
{
    std::vector<std::string> overrides{"sheet.resolution=9"};
    CHECK(plan_of("builtin:hanging", overrides).embree);  // for the picture
    overrides.push_back("output.picture=false");
    const RunPlan plan = plan_of("builtin:hanging", overrides);
    CHECK(plan.phases.size() == 1);
    CHECK_FALSE(plan.embree);
    CHECK_FALSE(plan.phases[0].queries_bodies);
    for (const PlannedLaunch& launch : plan.phases[0].launches) {
        CHECK(launch.name != "body_contact");
        CHECK(launch.name != "seam");
    }
    const FieldSet fields = required_fields(plan.phases[0].params);
    CHECK_FALSE(fields[std::size_t(Field::contact_normal)]);
    CHECK_FALSE(fields[std::size_t(Field::stitch_force)]);
}
