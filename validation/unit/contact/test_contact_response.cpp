#include <algorithm>
#include <cmath>
#include <map>

#include "host/model/body.hpp"
#include "host/model/cloth_model.hpp"
#include "host/scene/plan.hpp"
#include "host/solver/stepping/equilibrium.hpp"
#include "host/solver/stepping/integrator.hpp"
#include "host/solver/stepping/phase.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "io/scene/read_scene.hpp"
#include "kernels/repulsion.h"
#include "validation/measure/small_cloth.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

constexpr double gap = 0.002, g = 9.81, density = 0.2;

// A sheet above a plane; gravity is tilted by an angle towards -x.
struct Landing {
    ClothModel model;
    std::unique_ptr<BodyQuery> query;
    Profile profile;
    std::unique_ptr<Phase> phase;

    Landing(Params params, double height, double friction = 0, double lean = 0)
    {
        model.cloth = grid_cloth(5, 5, 0.02);
        for (Vec3& x : model.cloth.positions) x.z() = height;
        model.fabrics = test_fabrics();
        Fabric& fabric = model.fabrics.at("test");
        fabric.areal_density = density;
        fabric.stretch_weft = fabric.stretch_warp = 300;
        fabric.shear = 50;
        Body plane;
        plane.kind = Body::Kind::plane;
        plane.normal = Vec3::UnitZ();
        plane.friction = friction;
        model.bodies.push_back(plane);
        query = std::make_unique<BodyQuery>(model.bodies, Box(Vec3(-5, -5, -1), Vec3(5, 5, 1)));
        PhaseOptions options;
        options.params = params;
        options.params.membrane.scale = 1;
        options.params.plate.scale = 1;
        options.params.gravity.acceleration_x = -g * std::sin(lean);
        options.params.gravity.acceleration_z = -g * std::cos(lean);
        phase =
            std::make_unique<Phase>(model, options, query.get(), profile, model.cloth.positions, std::vector<Vec3>{});
    }

    double lowest() const
    {
        return height([](double a, double b) { return a < b; });
    }
    double highest() const
    {
        return height([](double a, double b) { return a > b; });
    }
    template <class Better>
    double height(const Better& better) const
    {
        const std::vector<Vec3> x = phase->positions();
        double best = x[0].z();
        for (const Vec3& p : x)
            if (better(p.z(), best)) best = p.z();
        return best;
    }
    Vec3 mean_velocity() const
    {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& v : phase->velocities()) sum += v / 25;
        return sum;
    }

    /// @param hear  called after every step
    template <class Hear>
    void fly(const char* integrator, double step, double until, const Hear& hear)
    {
        const auto scheme = make_integrator(integrator, *phase);
        EquilibriumOptions options;
        options.step.longest = step;
        options.integrator = scheme.get();
        options.newton_iterations = 40;
        DrapeProgress progress;
        drape_until(*phase, options, until, until, progress, [&](const StepEvent& event) {
            hear(event.time);
            return true;
        });
    }
};

Params rule(double restitution, double friction = 0)
{
    Params params;
    params.velocity_rule.gap = gap;
    params.velocity_rule.restitution = restitution;
    params.velocity_rule.friction = friction;
    return params;
}

RunPlan plan_of_response(const std::string& response)
{
    std::vector<std::string> overrides{"sheet.resolution=9", "contact.response=" + response};
    const Scene scene = read_scene("builtin:sphere", overrides);
    return make_plan(scene, build_scene_model(scene));
}

bool has(const std::vector<std::string>& names, const std::string& name)
{
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

TEST_CASE("the exponential law is zero where contact sets in, is the slope of its energy and is bounded", "[response]")
{
    for (double s : {1.0, 1.5, 100.0}) {
        CHECK(repulsion_at(s).value == 0);
        CHECK(repulsion_at(s).slope == 0);
    }
    CHECK(repulsion_at(1 - 1e-9).slope == Approx(0).margin(1e-8));
    const double h = 1e-6;
    for (double s : {0.98, 0.8, 0.5, 0.3, 0.15, 0.11, 0.05, 0.0, -3.0}) {
        const double above = repulsion_at(s + h).value, below = repulsion_at(s - h).value;
        CHECK((above - below) / (2 * h) == Approx(repulsion_at(s).slope).epsilon(1e-7));
        const double steeper = repulsion_at(s + h).slope, flatter = repulsion_at(s - h).slope;
        CHECK((steeper - flatter) / (2 * h) == Approx(repulsion_at(s).curvature).epsilon(1e-6).margin(1e-9));
        if (s >= 0.1) CHECK(-repulsion_at(s).slope == Approx(std::exp(1 / s) - std::exp(1.0)));
    }
    CHECK(-repulsion_at(-1e3).slope == Approx(std::exp(10.0) - std::exp(1.0)));
    CHECK(repulsion_at(0.1 - 1e-12).value == Approx(repulsion_at(0.1 + 1e-12).value));
}

TEST_CASE("under the exponential law a sheet rests where its weight is balanced", "[response]")
{
    for (double pressure : {0.5, 2.0, 200.0}) {
        Params params;
        params.body_repulsion.stiffness = pressure;
        params.body_repulsion.gap = gap;
        Landing sheet(params, 1.5 * gap);
        EquilibriumOptions options;
        options.tolerance = 1e-7;
        DrapeProgress progress;
        REQUIRE(drape_to_equilibrium(*sheet.phase, options, progress, [](const StepEvent&) { return true; }) ==
                PhaseEnd::reached);
        // P (exp(d / g) - e) = weight per area
        const double height = gap / std::log(std::exp(1.0) + density * g / pressure);
        CHECK(sheet.lowest() == Approx(height).epsilon(1e-6));
        CHECK(sheet.highest() == Approx(height).epsilon(1e-6));
    }
}

TEST_CASE("pseudo-time stepping to rest uses BDF2 until a static attempt fails, then implicit Euler with longer steps",
          "[response]")
{
    Params params;
    params.body_repulsion.stiffness = 2;
    params.body_repulsion.gap = gap;
    const double rest = gap / std::log(std::exp(1.0) + density * g / 2);
    const auto longest_step = [&](const char* name, double switch_residual, bool hurries) {
        Landing sheet(params, 0.05);
        const std::unique_ptr<Integrator> integrator = make_integrator(name, *sheet.phase);
        EquilibriumOptions options;
        options.integrator = integrator.get();
        options.hurries = hurries;
        options.step.longest = 0.02;
        options.tolerance = 1e-7;
        DrapeProgress progress;
        progress.switch_residual = switch_residual;
        double longest = 0;
        const auto hear = [&](const StepEvent& event) {
            if (progress.switch_residual == switch_residual) longest = std::max(longest, event.dt);
            return true;
        };
        REQUIRE(drape_to_equilibrium(*sheet.phase, options, progress, hear) == PhaseEnd::reached);
        CHECK(sheet.highest() == Approx(rest).epsilon(1e-6));
        return longest;
    };
    const double before = DrapeProgress{}.switch_residual, after_one = 0.5 * before;
    CHECK(longest_step("bdf2", before, true) == Approx(0.03));
    CHECK(longest_step("bdf2", after_one, true) == Approx(0.04));
    CHECK(longest_step("bdf2", before, false) == Approx(0.02));
    CHECK(longest_step("implicit_euler", before, true) == Approx(0.04));
}

TEST_CASE("with only_balances the drape ends when the forces first nearly balance, before any static attempt",
          "[response]")
{
    Params params;
    params.body_repulsion.stiffness = 2;
    params.body_repulsion.gap = gap;
    Landing sheet(params, 0.05);
    EquilibriumOptions options;
    options.tolerance = 1e-7;
    options.only_balances = true;
    DrapeProgress progress;
    const auto hear = [](const StepEvent& event) {
        CHECK(event.dt > 0);  // the step of a static iteration is 0
        return true;
    };
    REQUIRE(drape_to_equilibrium(*sheet.phase, options, progress, hear) == PhaseEnd::reached);
    CHECK(progress.residual <= DrapeProgress{}.switch_residual);
    CHECK(progress.residual > options.tolerance);
    CHECK(progress.switch_residual == DrapeProgress{}.switch_residual);
}

TEST_CASE("under the velocity rule a dropped sheet bounces to the height that restitution predicts", "[response]")
{
    const double drop = 0.1;
    const double impact = std::sqrt(2 * drop / g);
    for (const char* integrator : {"bdf2", "velocity_verlet", "central_difference", "implicit_euler"})
        for (double restitution : {0.0, 0.5, 1.0}) {
            INFO(integrator << ", restitution " << restitution);
            Landing sheet(rule(restitution), gap + drop);
            double top = 0;
            // The run ends shortly after the highest point of the first bounce.
            sheet.fly(integrator, 5e-4, impact * (1 + restitution) + 0.02, [&](double time) {
                if (time > impact + 0.003) top = std::max(top, sheet.highest() - gap);
                CHECK(sheet.lowest() >= gap - 1e-9);
            });
            CHECK(top == Approx(restitution * restitution * drop).epsilon(0.01).margin(1e-5));
        }
}

TEST_CASE("under the velocity rule Coulomb's friction holds or slows a sheet on an incline", "[response]")
{
    const double lean = 0.3, dt = 2e-3;
    // Only explicit schemes are tested: Newton's tolerance may leave part of a velocity gain to the next step.
    for (const char* integrator : {"velocity_verlet", "symplectic_euler"})
        for (double friction : {0.2, 0.4}) {  // tan 0.3 is 0.309
            INFO(integrator << ", friction " << friction);
            Landing sheet(rule(0, 1), gap, friction, lean);
            const double start = sheet.phase->positions()[12].x();
            sheet.fly(integrator, dt, 0.2, [](double) {});
            const double expected =
                friction < std::tan(lean) ? g * (std::sin(lean) - friction * std::cos(lean)) * 0.2 : 0;
            CHECK(-sheet.mean_velocity().x() == Approx(expected).epsilon(1e-6).margin(1e-9));
            if (expected == 0) CHECK(sheet.phase->positions()[12].x() == Approx(start).margin(1e-9));
        }
}

TEST_CASE("only the response that a scene names is planned, allocated and launched", "[response][plan]")
{
    const std::map<std::string, std::vector<std::string>> of_response{
        {"barrier", {"body_contact", "friction", "cloth_contact", "cloth_friction"}},
        {"exponential", {"body_repulsion", "friction", "cloth_repulsion", "cloth_friction"}},
        {"velocity_rule", {"velocity_rule"}}};
    const std::vector<std::string> all{"body_contact",    "body_repulsion", "velocity_rule", "friction",
                                       "cloth_repulsion", "cloth_contact",  "cloth_friction"};
    for (const auto& [response, own] : of_response) {
        INFO(response);
        const RunPlan plan = plan_of_response(response);
        std::vector<std::string> launched, skipped;
        for (const PlannedLaunch& launch : plan.phases.back().launches) launched.push_back(launch.name);
        for (const SkippedFeature& feature : plan.skipped) skipped.push_back(feature.name);
        for (const std::string& name : all) {
            INFO(name);
            CHECK(has(launched, name) == has(own, name));
            CHECK(has(plan.active, name) == has(own, name));
            CHECK(has(skipped, name) != has(own, name));
        }
        const FieldSet fields = required_fields(plan.phases.back().params);
        CHECK(fields[std::size_t(Field::contact_normal)]);
        for (Field field : {Field::pair_vertex, Field::friction_anchor, Field::contact_area})
            CHECK(fields[std::size_t(field)] == (response != "velocity_rule"));
    }
}

TEST_CASE("a step launches no response but the one in use", "[response]")
{
    Params barrier, exponential;
    barrier.body_contact.stiffness = exponential.body_repulsion.stiffness = 200;
    const std::vector<std::pair<Params, std::string>> cases{
        {barrier, "body_contact"}, {exponential, "body_repulsion"}, {rule(0.5), "velocity_rule"}};
    for (const auto& [params, own] : cases) {
        Landing sheet(params, 0.9 * gap);
        sheet.fly("bdf2", 5e-3, 0.02, [](double) {});
        for (const std::string name : {"body_contact", "body_repulsion", "velocity_rule"}) {
            INFO(name << " where " << own << " is in use");
            const auto& records = sheet.profile.records();
            const bool launched = std::any_of(records.begin(), records.end(), [&](const KernelRecord& record) {
                return record.name == name || record.name == name + "_stiffness";
            });
            CHECK(launched == (name == own));
        }
    }
}
