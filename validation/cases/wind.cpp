// Air on cloth against closed forms: the fall of a level sheet, a plate across and along the stream, taut sheets that
// bulge, and a curtain that is blown aside.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "host/model/cloth_model.hpp"
#include "host/solver/state/planes.hpp"
#include "host/solver/stepping/equilibrium.hpp"
#include "host/solver/stepping/phase.hpp"
#include "validation/cases/cases.hpp"
#include "validation/measure/specimen.hpp"

namespace selvage {
namespace {

constexpr double gravity = 9.81, areal_density = 0.15, air = 1.2, across = 1.3, along = 0.05;  // SI; coefficients
constexpr double degree = std::numbers::pi / 180;

void blow(Params& params, const Vec3& velocity)
{
    const auto set = [&](auto& term) {
        term.normal = air * across;
        term.tangential = air * along;
        term.velocity_x = velocity.x();
        term.velocity_y = velocity.y();
        term.velocity_z = velocity.z();
    };
    set(params.air_drag);
    if (!velocity.isZero()) set(params.wind);
}

ClothModel model_of(Cloth cloth, const Fabric& fabric)
{
    ClothModel model;
    model.cloth = std::move(cloth);
    model.fabrics = {{specimen_fabric, fabric}};
    return model;
}

double mean_fall(const State& s)
{
    double sum = 0;
    for (int v = 0; v < s.size.vertex_count; ++v) sum -= s.vel[2 * s.size.vertex_stride + v];
    return sum / s.size.vertex_count;
}

// v = v_t tanh(g t / v_t) with v_t^2 = 2 rho_area g / (rho_air c), the solution of v' = g - rho_air c / (2 rho_area)
// v^2.
void falling_sheet(CaseReport& report)
{
    report.from("v = v_t tanh(g t / v_t), v_t = sqrt(2 rho_area g / (rho_air c))");
    const double terminal = std::sqrt(2 * areal_density * gravity / (air * across)), rise = terminal / gravity;
    for (const auto& [name, steps, tolerance] : {std::tuple{"bdf2", 40, 1e-3},
                                                 {"implicit_midpoint", 40, 1e-3},
                                                 {"implicit_euler", 40, 0.02},
                                                 {"velocity_verlet", 400, 1e-5},
                                                 {"rk4", 400, 1e-6},
                                                 {"central_difference", 400, 1e-4}}) {
        const ClothModel model =
            model_of(flat_rectangle(MeshFamily::alternating, 0.3, 0.3, 4), isotropic_fabric(5, 0, 0, areal_density));
        PhaseOptions options;
        options.params.membrane.scale = 1;
        options.params.gravity.acceleration_z = -gravity;
        blow(options.params, Vec3::Zero());
        Profile profile;
        Phase phase(model, options, nullptr, profile, model.cloth.positions, {});
        const auto integrator = make_integrator(name, phase);
        NewtonOptions newton;
        newton.max_iterations = 40;
        newton.tolerance = 1e-10;
        newton.linear_tolerance = 1e-3;
        const double dt = 8 * rise / (8 * steps);
        double after_rise = 0;
        for (int k = 0; k < 8 * steps; ++k) {
            integrator->step(dt, newton);
            if (k + 1 == steps) after_rise = mean_fall(phase.state());
        }
        report.relative(fmt::format("{}: velocity of a level sheet after v_t/g in {} steps [m/s]", name, steps),
                        terminal * std::tanh(1.0), after_rise, tolerance);
        report.relative(fmt::format("{}: its terminal velocity [m/s]", name), terminal, mean_fall(phase.state()), 1e-6);
    }
}

Vec3 force_on_pins(const Specimen& sheet, const std::vector<int>& pins)
{
    Vec3 force = Vec3::Zero();
    for (const int v : pins) force += sheet.holding_force(v);
    return force;
}

std::vector<int> all_vertices(const Cloth& cloth)
{
    std::vector<int> all;
    for (int v = 0; v < int(cloth.positions.size()); ++v) all.push_back(v);
    return all;
}

// Drag and lift of a plate at an angle to the stream, whose normal and tangential parts are projected by hand.
void inclined_plate(CaseReport& report)
{
    report.from(
        "plate at an angle a: D = q A (c_n sin^3 a + c_t cos^3 a), L = q A sin a cos a (c_n sin a - c_t cos a)");
    const double speed = 4, pressure = 0.5 * air * speed * speed, area = 0.4 * 0.2;
    for (const double degrees : {90.0, 60.0, 30.0, 10.0}) {
        const double angle = degrees * degree, s = std::sin(angle), c = std::cos(angle);
        Cloth cloth = flat_rectangle(MeshFamily::irregular, 0.4, 0.2, 9);
        cloth.pinned = all_vertices(cloth);
        Params params;
        blow(params, speed * Vec3(c, 0, s));
        Specimen plate(cloth, isotropic_fabric(100, 0, 0, areal_density), params);
        plate.system().evaluate_forces(false);
        const Vec3 load = -force_on_pins(plate, cloth.pinned);
        const double drag = pressure * area * (across * s * s * s + along * c * c * c);
        const double lift = pressure * area * s * c * (across * s - along * c);
        report.relative(fmt::format("plate at {:g} degrees: drag [N]", degrees), drag, load.dot(Vec3(c, 0, s)), 1e-12);
        report.absolute(fmt::format("plate at {:g} degrees: lift [N]", degrees), lift, load.dot(Vec3(-s, 0, c)),
                        1e-12 * pressure * area);
    }
}

// A square sheet stretched by a strain, held at its rim, in wind across it. Its middle bulges by
//     w = 16 q a^2 / (pi^4 T) sum over odd m, n of (-1)^((m+n)/2 - 1) / (m n (m^2 + n^2))
double bulge_of_square(double pressure, double side, double tension)
{
    double sum = 0;
    for (int m = 1; m < 400; m += 2)
        for (int n = 1; n < 400; n += 2)
            sum += ((m + n) / 2 % 2 == 1 ? 1.0 : -1.0) / (double(m) * n * (double(m) * m + double(n) * n));
    return 16 * pressure * side * side / (std::pow(std::numbers::pi, 4) * tension) * sum;
}

bool is_on(double x, double low, double high) { return x < low + 1e-9 || x > high - 1e-9; }

// @param strip  held at its two ends only
void taut_sheet(CaseReport& report, bool strip)
{
    constexpr double stretch = 1.1, stiffness = 500, speed = 1;
    const double length = 0.5, width = strip ? 0.05 : 0.5;
    Cloth cloth = flat_rectangle(MeshFamily::alternating, length, width, strip ? 41 : 33);
    int middle = 0;
    const Vec2 centre(0.5 * length, 0);
    for (int v = 0; v < int(cloth.positions.size()); ++v) {
        const Vec2& x = cloth.panel_coordinates[v];
        if (is_on(x.x(), 0, length) || (!strip && is_on(x.y(), -0.5 * width, 0.5 * width))) cloth.pinned.push_back(v);
        if ((x - centre).norm() < (cloth.panel_coordinates[middle] - centre).norm()) middle = v;
        cloth.positions[v] = Vec3(stretch * x.x(), (strip ? 1 : stretch) * x.y(), 0);
    }
    Params params;
    params.membrane.scale = 1;
    blow(params, Vec3(0, 0, speed));
    Specimen sheet(cloth, isotropic_fabric(stiffness, 0, 0, areal_density), params);
    sheet.balance(1e-9);
    const double pressure = 0.5 * air * across * speed * speed, span = stretch * length;
    const double force_per_width = stiffness * 0.5 * (stretch * stretch - 1);  // second Piola-Kirchhoff stress
    // A strip keeps its width, so that its tension per width is the stress times the stretch.
    const double tension = strip ? stretch * force_per_width : force_per_width;
    const double area = span * (strip ? width : stretch * width);
    const char* name = strip ? "taut strip held at its ends" : "taut square held at its rim";
    report.from("balance of forces: all of the load stands on the pins");
    report.relative(fmt::format("{}: force on the pins [N]", name), pressure * area,
                    -force_on_pins(sheet, cloth.pinned).z(), 1e-3);
    report.from(strip ? "w = q L^2 / (8 T)" : "membrane of a square under pressure: its Fourier series");
    const double bulge = strip ? pressure * span * span / (8 * tension) : bulge_of_square(pressure, span, tension);
    report.relative(fmt::format("{}: deflection of its middle [m]", name), bulge, sheet.position(middle).z(),
                    strip ? 1e-3 : 3e-3);
}

// A curtain without bending hangs straight in steady wind: across it q cos^2 a = rho_area g sin a everywhere.
void curtain(CaseReport& report)
{
    report.from("q c cos^2 a = rho_area g sin a, a from the vertical");
    for (const double ratio : {0.3, 1.0}) {  // of the pressure across the stream to the weight
        const double speed = std::sqrt(2 * ratio * areal_density * gravity / (air * across));
        Cloth cloth = flat_rectangle(MeshFamily::alternating, 0.5, 0.1, 21);
        int lowest = 0;
        for (int v = 0; v < int(cloth.positions.size()); ++v) {
            Vec3& x = cloth.positions[v];
            if (x.x() < 1e-9) cloth.pinned.push_back(v);
            if (x.x() > cloth.positions[std::size_t(lowest)].x()) lowest = v;
        }
        const double start = 25 * degree;  // from which both curtains swing without folding
        for (Vec3& x : cloth.positions) x = Vec3(x.x() * std::sin(start), x.y(), -x.x() * std::cos(start));
        const ClothModel model = model_of(cloth, isotropic_fabric(2000, 0, 0, areal_density));
        PhaseOptions options;
        options.params.membrane.scale = 1;
        options.params.gravity.acceleration_z = -gravity;
        blow(options.params, Vec3(speed, 0, 0));
        options.params.wind.tangential = options.params.air_drag.tangential = 0;
        options.linear.max_iterations = 2000;
        Profile profile;
        Phase phase(model, options, nullptr, profile, cloth.positions, {});
        EquilibriumOptions rest;
        rest.tolerance = 1e-4;
        DrapeProgress progress;
        const PhaseEnd end = drape_to_equilibrium(phase, rest, progress, [](const StepEvent&) { return true; });
        if (end != PhaseEnd::reached) report.fail("the curtain does not come to rest");
        const Vec3 tip = phase.positions()[std::size_t(lowest)];
        const double angle = std::asin((std::sqrt(1 + 4 * ratio * ratio) - 1) / (2 * ratio));
        report.absolute(
            fmt::format("curtain, wind pressure over weight {:g}: angle from the vertical [degrees]", ratio),
            angle / degree, std::atan2(tip.x(), -tip.z()) / degree, 0.1);
    }
}

}  // namespace

void check_wind(CaseReport& report)
{
    falling_sheet(report);
    inclined_plate(report);
    taut_sheet(report, true);
    taut_sheet(report, false);
    curtain(report);
}

}  // namespace selvage
