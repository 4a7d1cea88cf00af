#include <cstring>
#include <set>

#include "host/mesh/body_tessellation.hpp"
#include "host/solver/stepping/equilibrium.hpp"
#include "host/solver/stepping/sleep.hpp"
#include "host/solver/stepping/step_control.hpp"
#include "host/solver/terms/unit_strengths.hpp"
#include "validation/measure/small_cloth.hpp"

using namespace selvage;

namespace {

// Everything that a query may write: every evaluation fills these fields before it reads them.
const std::set<std::string_view> workspace = {"face_force", "hinge_force", "stitch_force", "spring_force", "pair_force",
                                              "hinge_bend", "pair_weight", "pair_normal",  "pair_distance"};

template <class Number>
bool same_bits(const std::vector<Number>& a, const std::vector<Number>& b)
{
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Number)) == 0);
}

void check_same(const State& state, const State& before)
{
#define FIELD(type, name, per, components, unit, meaning)                         \
    {                                                                             \
        INFO(#name);                                                              \
        CHECK((workspace.contains(#name) || same_bits(state.name, before.name))); \
    }
#include "kernels/fields.def"
#include "validation/unit/catch.hpp"
    CHECK(state.awake.all == before.awake.all);
    CHECK(same_bits(state.awake.is_awake, before.awake.is_awake));
    CHECK(same_bits(state.awake.hinge, before.awake.hinge));
    CHECK(state.awake.force_squared == before.awake.force_squared);
}

struct Answers {
    double residual, potential, kinetic;
    Energies energies;
};

Answers ask(const System& system)
{
    return {system.residual(), system.potential_energy(), system.kinetic_energy(), system.energies()};
}

// A sheet that hangs by two corners, or that a ball rises against.
struct Sheet {
    ClothModel model;
    std::unique_ptr<BodyQuery> query;
    Profile profile;
    std::unique_ptr<Phase> phase;

    explicit Sheet(bool ball)
    {
        model.cloth = grid_cloth(9, 9, 0.02);
        model.cloth.pinned = {72, 80};
        model.fabrics = test_fabrics();
        Fabric& fabric = model.fabrics.at("test");
        fabric.areal_density = 0.2;
        fabric.stretch_weft = fabric.stretch_warp = 300;
        fabric.shear = 50;
        fabric.bending_weft = fabric.bending_warp = 1e-5;
        PhaseOptions options;
        options.params.gravity.acceleration_z = -9.81;
        options.params.membrane.scale = 1;
        options.params.plate.scale = 1;
        if (ball) add_ball(options.params);
        phase =
            std::make_unique<Phase>(model, options, query.get(), profile, model.cloth.positions, std::vector<Vec3>{});
    }

    void add_ball(Params& params)
    {
        Body ball;
        ball.mesh = sphere_mesh(Vec3(0.08, 0.08, -0.05), 0.04, 2);
        ball.motion = std::make_shared<BodyMotion>(std::vector<MotionKey>{{}, {0.5, Vec3(0, 0, 0.05), Vec3::Zero()}},
                                                   false, Vec3::Zero());
        model.bodies = {ball};
        query = std::make_unique<BodyQuery>(model.bodies, Box(Vec3(-1, -1, -1), Vec3(1, 1, 1)));
        params.body_repulsion.stiffness = 2;
        params.body_repulsion.gap = 0.002;
        params.cloth_repulsion.stiffness = 2;
        params.cloth_repulsion.gap = 0.001;
    }
};

std::vector<char> upper_half(const Cloth& cloth)
{
    std::vector<char> result;
    for (const Vec2& u : cloth.panel_coordinates) result.push_back(u.y() > 0.08);
    return result;
}

}  // namespace

TEST_CASE("residual and energies leave a state with every term as it was, bit for bit")
{
    Params params = unit_strengths();
    params.gravity.acceleration_z = -9.81;
    Profile profile;
    System system(crumpled_state(params), params, profile);
    system.evaluate_forces(true);
    system.evaluate_stiffness(true, 1);
    const State before = system.state();
    const Answers first = ask(system), second = ask(system);
    check_same(system.state(), before);
    CHECK(first.residual == second.residual);
    CHECK(first.potential == second.potential);
    CHECK(first.residual > 0);
}

TEST_CASE("residual and energies leave cloth of which a part sleeps as it was, bit for bit")
{
    Sheet sheet(false);
    System& system = sheet.phase->system();
    implicit_euler_step(sheet.phase->newton(), 0.01, {});
    const double awake = system.potential_energy();
    put_to_sleep(system, upper_half(sheet.model.cloth), 1e-6);
    const State before = system.state();
    const Answers answers = ask(system);
    check_same(system.state(), before);
    CHECK(answers.potential == awake);  // what sleeps counts as well
}

TEST_CASE("steps go the same way whether or not somebody asks for residual and energies in between")
{
    for (const bool ball : {false, true}) {
        Sheet asked(ball), left(ball);
        for (int step = 0; step < 8; ++step) {
            for (Sheet* sheet : {&asked, &left}) {
                sheet->phase->system().refresh_pairs();
                if (sheet == &asked) ask(sheet->phase->system());
                implicit_euler_step(sheet->phase->newton(), 0.01, {});
                if (sheet == &asked) ask(sheet->phase->system());
            }
            if (step == 4 && !ball) {
                for (Sheet* sheet : {&asked, &left}) {
                    sheet->phase->system().evaluate_forces(false);
                    put_to_sleep(sheet->phase->system(), upper_half(sheet->model.cloth), 1e-6);
                }
            }
            CHECK(same_bits(asked.phase->state().pos, left.phase->state().pos));
            CHECK(same_bits(asked.phase->state().vel, left.phase->state().vel));
        }
    }
}

TEST_CASE("energies by family sum to the energy of the cloth, and contact counts every law of contact and friction")
{
    Params params = unit_strengths();
    params.gravity.acceleration_z = -9.81;
    Profile profile;
    System system(crumpled_state(params), params, profile);
    const Energies e = system.energies();
    CHECK(e.gravity + e.membrane + e.bending + e.seam + e.contact == Approx(system.potential_energy()));
    CHECK(e.kinetic == system.kinetic_energy());
    double contact = 0;
    for (const Term& term : all_terms())
        if (term.name.find("contact") != std::string_view::npos ||
            term.name.find("repulsion") != std::string_view::npos ||
            term.name.find("friction") != std::string_view::npos)
            contact += term.energy(system.state(), params);
    CHECK(e.contact == Approx(contact));
    CHECK(e.contact > 0);
}

TEST_CASE("after steps that failed and were retried, bodies, contact and steps read one time")
{
    Sheet sheet(true);
    System& system = sheet.phase->system();
    const auto integrator = make_integrator("implicit_euler", *sheet.phase);
    StepControl control(*sheet.phase, *integrator, {.longest = 0.02, .moves_boundary = true});
    NewtonOptions newton;
    newton.max_iterations = 4;
    newton.tolerance = 1e-4;  // which not every step of that length reaches
    double time = 0;
    while (time < 0.1) {
        time += control.advance(0.1 - time, newton, true);
        CHECK(system.clock().time == time);
        CHECK(system.clock().dt == 0);
        CHECK(sheet.query->time() == time);
        const std::vector<Vec3> ball = body_mesh_at(sheet.model.bodies[0], time).vertices;
        const ConstPlanes corners{system.state().body_point.data(), system.state().size.body_point_stride};
        for (std::size_t k = 0; k < ball.size(); ++k) CHECK(corners(int(k)) == ball[k]);
    }
    CHECK(control.retries() > 0);
}

TEST_CASE("events of a way to rest name the integrator that took the step, also after another has taken over")
{
    for (const bool swings : {true, false}) {
        Sheet sheet(false);
        const auto integrator = make_integrator("bdf2", *sheet.phase);
        EquilibriumOptions options;
        options.integrator = integrator.get();
        DrapeProgress progress;
        if (!swings) progress.switch_residual = 0.5 * RestTuning{}.first_residual;
        std::string first;
        const auto hear = [&](const StepEvent& event) {
            if (first.empty()) first = event.integrator;
            return event.dt == 0 || event.time < 0.1;
        };
        drape_to_equilibrium(*sheet.phase, options, progress, hear);
        CHECK(first == (swings ? "bdf2" : "implicit_euler"));
    }
}
