#include <array>
#include <cmath>
#include <random>

#include "host/solver/state/rest_state.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "host/solver/terms/unit_strengths.hpp"
#include "io/scene/fabric_table.hpp"
#include "io/scene/read_scene.hpp"
#include "io/scene/scene.hpp"
#include "validation/measure/finite_differences.hpp"
#include "validation/measure/small_cloth.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

// Responses to a uniform deformation F (by rows), computed in 30 digits from the energy densities: first
// Piola-Kirchhoff stress P [N/m] by rows and energy per area W [J/m^2].
struct PatchCase {
    const char* name;
    std::array<double, 4> F, P;
    double W;
};

// Isotropic Saint Venant-Kirchhoff sheet, E h = 100 N/m, nu = 0.3.
constexpr PatchCase isotropic_cases[] = {
    {"uniaxial 0.99, free sides", {0.99, 0, 0, 1.0029805581366}, {-0.98505, 0, 0, 0}, 0.004950125},
    {"uniaxial 1.05, clamped sides", {1.05, 0, 0, 1}, {5.91346153846154, 0, 0, 1.68956043956044}, 0.144316620879121},
    {"equibiaxial 1.1", {1.1, 0, 0, 1.1}, {16.5, 0, 0, 16.5}, 1.575},
    {"simple shear 0.2",
     {1, 0.2, 0, 1},
     {2.1978021978022, 8.13186813186813, 7.69230769230769, 2.1978021978022},
     0.791208791208791},
    {"trellis shear 0.5",
     {0.968912421710645, 0.247403959254523, 0.247403959254523, 0.968912421710645},
     {4.56199140070815, 17.8662061399588, 17.8662061399588, 4.56199140070815},
     4.42017013588327},
};

// Weft 50 e + 800 e^2, warp 100 e + 2000 e^2 + 5000 e^3, shear 5 g + 300 g^3.
constexpr PatchCase cubic_cases[] = {
    {"weft 1.1", {1.1, 0, 0, 1}, {15.477, 0, 0, 0}, 0.584325},
    {"warp 1.05", {1, 0, 0, 1.05}, {0, 0, 0, 11.6037407226562}, 0.229692548624674},
    {"biaxial 1.05", {1.05, 0, 0, 1.05}, {4.8969375, 0, 0, 11.6037407226562}, 0.331252965291341},
    {"simple shear 0.2", {1, 0.2, 0, 1}, {0.68, 3.968, 3.4, 2.84}, 0.245533333333333},
    {"bias 1.05",
     {1.00119047619048, 0.0488095238095238, 0.0488095238095238, 1.00119047619048},
     {0.161328650146218, 0.781852548153746, 0.775702698945938, 0.287475557067358},
     0.0311621021989113},
};

constexpr int side = 5;
constexpr double spacing = 0.1, width = spacing * (side - 1);

// A square of irregular triangles: the inner vertices of a grid are moved by up to 30 % of its spacing.
Cloth irregular_square()
{
    Cloth cloth = grid_cloth(side, side, spacing);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(-0.3 * spacing, 0.3 * spacing);
    for (int r = 1; r + 1 < side; ++r)
        for (int c = 1; c + 1 < side; ++c)
            cloth.panel_coordinates[r * side + c] += Vec2(uniform(random), uniform(random));
    return cloth;
}

State deformed_square(const Params& params, const Fabric& fabric, const std::array<double, 4>& F)
{
    Cloth cloth = irregular_square();
    for (std::size_t v = 0; v < cloth.positions.size(); ++v) {
        const Vec2 u = cloth.panel_coordinates[v];
        cloth.positions[v] = Vec3(F[0] * u.x() + F[1] * u.y(), F[2] * u.x() + F[3] * u.y(), 0);
    }
    const Topology topology = make_topology(cloth, false);
    State state(topology_sizes(topology, 1), required_fields(params));
    fill_state(state, topology, cloth, {{"test", fabric}}, cloth.positions, {});
    return state;
}

const Term& term_named(std::string_view name)
{
    for (const Term& term : all_terms())
        if (term.name == name) return term;
    throw std::runtime_error("no such term");
}

void check_patch(const PatchCase& patch, const Fabric& fabric, const char* term_name)
{
    INFO(term_name << ": " << patch.name);
    const Params params = unit_strengths();
    State state = deformed_square(params, fabric, patch.F);
    const Term& term = term_named(term_name);
    const std::vector<real> force = term_force(term, state, params);
    const int vs = state.size.vertex_stride;
    const double scale = std::hypot(patch.P[0], patch.P[3]) + std::abs(patch.P[1]);
    for (int c = 0; c < 2; ++c) {
        // By virtual work the sum of f_c X over the vertices is minus the area times P.
        double moment_x = 0, moment_y = 0;
        const Cloth cloth = irregular_square();
        for (int v = 0; v < side * side; ++v) {
            moment_x -= force[c * vs + v] * cloth.panel_coordinates[v].x();
            moment_y -= force[c * vs + v] * cloth.panel_coordinates[v].y();
        }
        CHECK(std::abs(moment_x / (width * width) - patch.P[2 * c]) <= 1e-10 * scale);
        CHECK(std::abs(moment_y / (width * width) - patch.P[2 * c + 1]) <= 1e-10 * scale);
    }
    // The force on the right edge. The contributions of the upper and lower edges to its corners cancel.
    for (int c = 0; c < 2; ++c) {
        double edge = 0;
        for (int r = 0; r < side; ++r) edge -= force[c * vs + r * side + side - 1];
        CHECK(std::abs(edge - width * patch.P[2 * c]) <= 1e-10 * scale * width);
    }
    CHECK(term.energy(state, params) == Approx(patch.W * width * width).epsilon(1e-10));
}

Fabric isotropic_fabric()
{
    Fabric fabric;
    fabric.stretch_weft = fabric.stretch_warp = 100 / (1 - 0.09);
    fabric.stretch_coupling = 0.3 * fabric.stretch_weft;
    fabric.shear = 100 / 2.6;
    return fabric;
}

}  // namespace

TEST_CASE("an irregular patch shows the exact forces and energy of an isotropic sheet", "[curves]")
{
    for (const PatchCase& patch : isotropic_cases)
        for (const char* term : {"membrane", "curved_membrane"}) check_patch(patch, isotropic_fabric(), term);
}

TEST_CASE("an irregular patch shows the exact forces and energy of cubic stress curves", "[curves]")
{
    Fabric fabric;
    fabric.stretch_coupling = 0;
    fabric.stretch_weft_curve = cubic_curve(50, 800, 0);
    fabric.stretch_warp_curve = cubic_curve(100, 2000, 5000);
    fabric.shear_curve = cubic_curve(5, 0, 300);
    for (const PatchCase& patch : cubic_cases) check_patch(patch, fabric, "curved_membrane");
}

TEST_CASE("curves pass through their points, rise everywhere, and their energy is the integral of stress", "[curves]")
{
    const std::vector<Vec2> points{{0.02, 5}, {0.05, 30}, {0.06, 31}, {0.12, 490}};
    for (const StressCurve& curve :
         {piecewise_curve(points), smooth_curve(points), limited_curve(smooth_curve(points), 0.08, 20)}) {
        for (const Vec2& p : points)
            if (p.x() < 0.08) CHECK(curve_stress(curve, p.x()) == Approx(p.y()).epsilon(1e-12));
        CHECK(smallest_slope(curve) > 0);
        double energy = 0, last = 0;
        const int steps = 120000;
        for (int i = 0; i < steps; ++i) {
            const double e = 0.12 * (i + 1) / steps, s = curve_stress(curve, e);
            REQUIRE(s > last);
            energy += 0.5 * (s + last) * 0.12 / steps;
            last = s;
        }
        const std::vector<double> starts = start_energies(curve);
        const CurveRange& r = curve.back();
        const double d = 0.12 - r.start;
        CHECK(starts.back() + d * (r.stress + 0.5 * d * r.slope) == Approx(energy).epsilon(1e-6));
    }
}

TEST_CASE("a smooth curve has no kinks", "[curves]")
{
    const StressCurve curve = smooth_curve({{0.02, 5}, {0.05, 30}, {0.06, 31}, {0.12, 490}});
    for (const CurveRange& range : curve)
        if (range.start > 0)
            CHECK(curve_slope(curve, range.start - 1e-12) == Approx(curve_slope(curve, range.start)).epsilon(1e-6));
}

TEST_CASE("measured points are converted to the membrane's measures and back without loss of work", "[curves]")
{
    for (CurveMeasure measure : {CurveMeasure::tension, CurveMeasure::shear}) {
        const Vec2 point = membrane_point(measure, {0.3, 7});
        CHECK((measured_point(measure, point) - Vec2(0.3, 7)).norm() < 1e-14);
    }
    // A force P = 100 x does the work 100 x^2 / 2, which the integral of s de must equal.
    double work = 0;
    for (int i = 0; i < 10000; ++i) {
        const Vec2 a = membrane_point(CurveMeasure::tension, {0.3 * i / 10000, 30.0 * i / 10000});
        const Vec2 b = membrane_point(CurveMeasure::tension, {0.3 * (i + 1) / 10000, 30.0 * (i + 1) / 10000});
        work += 0.5 * (a.y() + b.y()) * (b.x() - a.x());
    }
    CHECK(work == Approx(4.5).epsilon(1e-6));
}

TEST_CASE("a strip beyond its over-elongation limit is 20 times as stiff", "[curves]")
{
    Fabric fabric;
    fabric.stretch_weft = 300;
    fabric.stretch_limit = 0.1;
    const StressCurve weft = membrane_curves(fabric)[0];
    const double limit = 0.1 + 0.005;
    CHECK(curve_slope(weft, limit - 1e-9) == Approx(300));
    CHECK(curve_slope(weft, limit + 1e-9) == Approx(6000));
    CHECK(curve_stress(weft, limit + 0.01) == Approx(300 * limit + 60));
}

TEST_CASE("a fabric table's curve replaces an inherited number, and its number replaces an inherited curve", "[curves]")
{
    Fabric wool = fabric_preset("wool_suiting");
    CHECK_FALSE(wool.stretch_weft_curve.empty());
    CHECK(wool.stretch_weft == wool.stretch_weft_curve[0].slope);
    const std::vector<std::string> none;
    const std::vector<std::string> number{"fabric.wool_suiting.stretch_weft=700", "sheet.fabric=wool_suiting"};
    const Scene scene = read_scene("builtin:hanging", number);
    CHECK(scene.fabrics.at("wool_suiting").stretch_weft_curve.empty());
    CHECK(scene.fabrics.at("wool_suiting").stretch_weft == 700);
    CHECK_FALSE(scene.fabrics.at("wool_suiting").stretch_warp_curve.empty());
    const std::vector<std::string> curve{"fabric.cotton.shear_curve=[[0.1, 3], [0.5, 30]]"};
    const Fabric cotton = read_scene("builtin:hanging", curve).fabrics.at("cotton");
    CHECK(cotton.shear == Approx(3 / std::sin(0.1)));
    CHECK(curve_stress(cotton.shear_curve, std::sin(0.5)) == Approx(30));
}
