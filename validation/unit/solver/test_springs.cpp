#include <cmath>
#include <random>

#include "host/model/cloth_model.hpp"
#include "host/scene/plan.hpp"
#include "host/solver/state/rest_state.hpp"
#include "host/solver/state/springs.hpp"
#include "host/solver/stepping/equilibrium.hpp"
#include "host/solver/stepping/phase.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "io/scene/read_scene.hpp"
#include "validation/measure/finite_differences.hpp"
#include "validation/measure/small_cloth.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

const Term& spring_term()
{
    for (const Term& term : all_terms())
        if (term.name == "spring") return term;
    throw std::runtime_error("no such term");
}

Params spring_params(double membrane, double bending)
{
    Params params;
    params.spring.scale = membrane;
    params.spring.bend_scale = bending;
    return params;
}

Cloth irregular_cloth(int side, double shift)
{
    Cloth cloth = grid_cloth(side, side);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-0.1 * shift, 0.1 * shift);
    for (int r = 1; r + 1 < side; ++r)
        for (int c = 1; c + 1 < side; ++c)
            cloth.panel_coordinates[r * side + c] += Vec2(uniform(random), uniform(random));
    for (std::size_t v = 0; v < cloth.positions.size(); ++v) cloth.positions[v] << cloth.panel_coordinates[v], 0;
    return cloth;
}

State spring_state_of(const Cloth& cloth, const FabricTable& fabrics, const Params& params)
{
    Topology topology = make_topology(cloth, false);
    add_springs(topology, cloth, fabrics, springs_of(params));
    State state(topology_sizes(topology, int(fabrics.size())), required_fields(params));
    fill_state(state, topology, cloth, fabrics, cloth.positions, {});
    return state;
}

// Returns the energy per area of a small strain (e_uu, e_vv, g) = t (u, v, g), divided by t^2.
double modulus(const Cloth& cloth, const FabricTable& fabrics, double u, double v, double g)
{
    const Params params = spring_params(1, 0);
    State state = spring_state_of(cloth, fabrics, params);
    const int vs = state.size.vertex_stride;
    double total = 0;
    const double tiny = 1e-4;
    for (double sign : {-tiny, tiny}) {
        for (int p = 0; p < state.size.vertex_count; ++p) {
            const Vec2 x = cloth.panel_coordinates[p];
            state.pos[p] = x.x() * (1 + sign * u) + 0.5 * sign * g * x.y();
            state.pos[vs + p] = x.y() * (1 + sign * v) + 0.5 * sign * g * x.x();
        }
        total += spring_term().energy(state, params);
    }
    return total / (tiny * tiny * cloth.panels[0].rest_area);
}

// The strain by which its own weight would stretch a hanging strip at the upper end without the limit [1].
constexpr double hanging_load = 0.2 * 9.81 * 0.16 / 10;

double hanging_elongation(Params params, double limit)
{
    ClothModel model;
    model.cloth = grid_cloth(3, 9, 0.02);
    model.cloth.pinned = {24, 25, 26};
    for (Vec3& x : model.cloth.positions) x = Vec3(x.x(), 0, x.y());
    model.fabrics = test_fabrics();
    Fabric& fabric = model.fabrics.at("test");
    fabric.areal_density = 0.2;
    fabric.stretch_weft = fabric.stretch_warp = 10;
    fabric.shear = 0.5;
    fabric.bending_weft = fabric.bending_warp = 1e-6;
    fabric.damping = 0;
    fabric.stretch_limit = limit;
    PhaseOptions options;
    options.params = params;
    options.params.gravity.acceleration_z = -9.81;
    Profile profile;
    Phase phase(model, options, nullptr, profile, model.cloth.positions, {});
    DrapeProgress progress;
    REQUIRE(drape_to_equilibrium(phase, {}, progress, [](const StepEvent&) { return true; }) == PhaseEnd::reached);
    const std::vector<Vec3> x = phase.positions();
    return (x[25] - x[22]).norm() / 0.02 - 1;
}

}  // namespace

TEST_CASE("elastic stores K (1 - r)^2 / (2 r) per length of the edge along which it is sewn", "[springs]")
{
    Cloth cloth = grid_cloth(5, 3, 0.02);
    cloth.elastics = {{{0, 1, 2, 3, 4}, 0.8, 30}};
    Params params;
    params.spring.elastic_scale = 1;
    State state = spring_state_of(cloth, test_fabrics(), params);
    CHECK(state.size.spring_count == 4);
    CHECK(spring_term().energy(state, params) == Approx(30 * 0.2 * 0.2 / (2 * 0.8) * 0.08).epsilon(1e-6));
    for (int p = 0; p < state.size.vertex_count; ++p) state.pos[p] *= 1.6;  // at twice its length its tension is K
    const double stretched = spring_term().energy(state, params);
    for (int p = 0; p < state.size.vertex_count; ++p) state.pos[p] *= 1.001;
    CHECK((spring_term().energy(state, params) - stretched) / (0.08 * 1.6 * 0.001) == Approx(30).epsilon(1e-2));
}

TEST_CASE("springs on a grid show the fabric's stretch and shear stiffness, and the shear stiffness as coupling",
          "[springs]")
{
    const FabricTable fabrics =
        test_fabrics();  // weft 3, warp 2, shear 0.7 N/m; its coupling of 0.5 N/m is not followed
    const Cloth cloth = grid_cloth(6, 5);
    CHECK(modulus(cloth, fabrics, 1, 0, 0) == Approx(3).epsilon(1e-6));
    CHECK(modulus(cloth, fabrics, 0, 1, 0) == Approx(2).epsilon(1e-6));
    CHECK(modulus(cloth, fabrics, 0, 0, 1) == Approx(0.7).epsilon(1e-6));
    CHECK(modulus(cloth, fabrics, 1, 1, 0) == Approx(3 + 2 + 2 * 0.7).epsilon(1e-6));
    CHECK(modulus(cloth, fabrics, 1, 0, 1) == Approx(3 + 0.7).epsilon(1e-6));
}

TEST_CASE("springs on a grid pull a strip without shear stiffness exactly by its tension", "[springs]")
{
    FabricTable fabrics = test_fabrics();
    fabrics.at("test").shear = 0;
    const Params params = spring_params(1, 0);
    const int columns = 6, rows = 4;
    Cloth cloth = grid_cloth(columns, rows);
    for (Vec3& x : cloth.positions) x.x() *= 1.2;
    State state = spring_state_of(cloth, fabrics, params);
    const std::vector<real> force = term_force(spring_term(), state, params);
    double pull = 0, across = 0;
    for (int r = 0; r < rows; ++r) {
        pull -= force[r * columns + columns - 1];
        for (int c = 1; c + 1 < columns; ++c) CHECK(std::abs(force[r * columns + c]) < 1e-12);
    }
    for (int v = 0; v < columns * rows; ++v) across += std::abs(force[state.size.vertex_stride + v]);
    CHECK(pull == Approx(3 * 0.2 * 0.1 * (rows - 1)).epsilon(1e-9));
    CHECK(across < 1e-12);
}

TEST_CASE("springs on irregular triangles that are strained uniformly show the fabric's stiffness within 2 %",
          "[springs]")
{
    const Cloth cloth = irregular_cloth(13, 0.25);
    const FabricTable fabrics = test_fabrics();
    CHECK(modulus(cloth, fabrics, 1, 0, 0) == Approx(3).epsilon(0.02));
    CHECK(modulus(cloth, fabrics, 0, 1, 0) == Approx(2).epsilon(0.02));
    CHECK(modulus(cloth, fabrics, 0, 0, 1) == Approx(0.7).epsilon(0.02));
}

TEST_CASE("a fit with non-negative unknowns is the best one", "[springs]")
{
    Eigen::MatrixXd moduli(2, 2);
    moduli << 1, 1, 0, 1;
    CHECK((fit_non_negative(moduli, Eigen::Vector2d(3, 1)) - Eigen::Vector2d(2, 1)).norm() < 1e-12);
    CHECK((fit_non_negative(moduli, Eigen::Vector2d(1, 3)) - Eigen::Vector2d(0, 2)).norm() < 1e-12);
    CHECK(fit_non_negative(moduli, Eigen::Vector2d(-1, -1)).norm() == 0);
}

TEST_CASE("the over-elongation limits of springs and faces keep a loaded strip within 6 % of the limit", "[springs]")
{
    Params faces;
    faces.curved_membrane.scale = faces.bending.scale = 1;
    for (const Params& params : {spring_params(1, 1), faces}) {
        CHECK(hanging_elongation(params, 0) > 0.85 * hanging_load);
        const double held = hanging_elongation(params, 0.5 * hanging_load);
        CHECK(held > 0.45 * hanging_load);
        CHECK(held < 1.06 * 0.5 * hanging_load);
    }
}

TEST_CASE("a bend spring stores the energy of a hinge at the reference curvature", "[springs]")
{
    const FabricTable fabrics = test_fabrics();
    const double size = 0.004;  // [m]; the fold angle is 0.2 rad
    Cloth cloth = grid_cloth(2, 2, size);
    Params params = spring_params(0, 1);
    params.bending.scale = 1;
    const double height = size / std::sqrt(2.0), angle = bend_spring_curvature * height;
    // Rotates the corner (1, 1) about the diagonal from (1, 0) to (0, 1).
    const Vec3 along = Vec3(-1, 1, 0).normalized(), middle(0.5 * size, 0.5 * size, 0);
    cloth.positions[3] = middle + Eigen::AngleAxisd(angle, along).toRotationMatrix() * (cloth.positions[3] - middle);
    State state = spring_state_of(cloth, fabrics, params);
    double hinge = 0, spring = 0;
    for (const Term& term : all_terms()) {
        if (term.name == "bending") hinge = term.energy(state, params);
        if (term.name == "spring") spring = term.energy(state, params);
    }
    CHECK(hinge > 0);
    CHECK(spring == Approx(hinge).epsilon(0.02));
}

TEST_CASE("a plan with springs has no forces of faces and hinges", "[springs][plan]")
{
    const std::vector<std::string> overrides{"sheet.resolution=9", "membrane.model=springs"};
    const Scene scene = read_scene("builtin:hanging", overrides);
    const RunPlan plan = make_plan(scene, build_scene_model(scene));
    const FieldSet fields = required_fields(plan.phases[0].params);
    CHECK(fields[std::size_t(Field::spring_force)]);
    CHECK_FALSE(fields[std::size_t(Field::face_force)]);
    CHECK_FALSE(fields[std::size_t(Field::hinge_force)]);
    CHECK(plan.phases[0].params.spring.bend_scale == 1);
}
