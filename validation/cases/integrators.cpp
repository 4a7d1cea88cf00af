// The integrators: oscillation_references.csv, their orders of convergence, and the quantities that they must conserve.
#include <cmath>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "host/model/cloth_model.hpp"
#include "host/solver/state/planes.hpp"
#include "host/solver/terms/cloth_state.hpp"
#include "validation/cases/cases.hpp"
#include "validation/measure/oscillator.hpp"
#include "validation/measure/reference.hpp"
#include "validation/measure/specimen.hpp"

namespace selvage {
namespace {

// The amplitude factor per step and the frequency of each scheme for a mass on a spring with omega = 10 rad/s.
void step_factors(CaseReport& report)
{
    const std::string test = "integrator_undamped_k100";
    const std::pair<const char*, const char*> schemes[] = {{"implicit_euler", "backward_euler"},
                                                           {"implicit_midpoint", "implicit_midpoint"},
                                                           {"symplectic_euler", "symplectic_euler"},
                                                           {"velocity_verlet", "symplectic_euler"},
                                                           {"bdf2", "bdf2"}};
    const std::pair<const char*, double> steps[] = {{"0.001", 1e-3}, {"0.01", 1e-2}, {"1/60", 1.0 / 60}};
    for (const auto& [name, reference] : schemes)
        for (const auto& [label, dt] : steps) {
            Oscillator oscillator(name, 10, 0, 1e-4);
            std::vector<double> motion;
            for (int k = 0; k < 1000; ++k) {
                oscillator.step(dt);
                if (k >= 30) motion.push_back(oscillator.height());  // the effect of BDF2's first step has decayed
            }
            const StepFactor factor = fit_step_factor(motion, dt);
            const std::string key = std::string(reference) + "_omega_dt=" + label;
            report.relative(fmt::format("{}, dt {}: frequency of a mass on a spring [rad/s]", name, label),
                            oscillation_reference(test, key), factor.frequency, 1e-6);
            const bool damps = std::string(name) == "implicit_euler" || std::string(name) == "bdf2";
            const double amplitude =
                damps ? oscillation_reference(test, std::string(reference) + "_amp_per_step_dt=" + label) : 1;
            report.relative(fmt::format("{}, dt {}: amplitude factor of a step", name, label), amplitude,
                            factor.amplitude, 1e-6);
        }
}

void damped(CaseReport& report)
{
    for (const auto& [name, tolerance] :
         {std::pair{"rk4", 1e-6}, {"implicit_midpoint", 1e-3}, {"velocity_verlet", 1e-3}}) {
        Oscillator oscillator(name, 10, 0.4, 1e-4);
        for (int k = 0; k < 2000; ++k) oscillator.step(1e-3);
        report.absolute(fmt::format("{}, dt 0.001: damped oscillator, x(2) / x0", name),
                        oscillation_reference("damped_oscillator", "x(2)") / 0.1, oscillator.height(), tolerance);
        report.absolute(fmt::format("{}, dt 0.001: damped oscillator, v(2) / (x0 omega)", name),
                        oscillation_reference("damped_oscillator", "v(2)"), oscillator.speed() / 10, tolerance);
    }
}

// A mass of 1 kg on a spring of 1 m and 100 N/m, released at 30 degrees. It is a triangle with two pinned corners: one
// of its sides acts as the spring, and the others carry no force. The table's rows with a damper in the spring cannot
// be modelled and are left out.
class ElasticPendulum {
public:
    explicit ElasticPendulum(std::string_view integrator)
    {
        model_.cloth.positions = {{0, 0, 0}, {0.5, 0, -std::sqrt(0.75)}, {0, 1, 0}};
        model_.cloth.panel_coordinates = {{0, 0}, {1, 0}, {0, 1}};
        model_.cloth.faces = {{0, 1, 2}};
        model_.cloth.pinned = {0, 2};
        model_.cloth.panels = {one_panel(model_.cloth)};
        model_.fabrics = {{specimen_fabric, isotropic_fabric(1, 0, 0, 1)}};
        PhaseOptions options;
        options.params.spring.scale = 1;
        options.params.gravity.acceleration_z = -9.81;
        phase_ =
            std::make_unique<Phase>(model_, options, nullptr, profile_, model_.cloth.positions, std::vector<Vec3>());
        State& s = phase_->state();
        const int ss = s.size.spring_stride;
        for (int k = 0; k < s.size.spring_count; ++k) {
            const bool hangs = s.spring_vertex[k] + s.spring_vertex[ss + k] == 1;
            s.spring_length[k] = 1;
            s.spring_constant[k] = s.spring_constant[ss + k] = hangs ? 100 : 0;
        }
        s.mass[1] = s.inv_mass[1] = 1;
        integrator_ = make_integrator(integrator, *phase_);
    }
    void step(double dt) { integrator_->step(dt, exact_steps()); }
    double x() const { return phase_->state().pos[1]; }
    double y() const { return phase_->state().pos[2 * phase_->state().size.vertex_stride + 1]; }
    double energy() { return phase_->system().potential_energy() + phase_->system().kinetic_energy(); }

private:
    ClothModel model_;
    Profile profile_;
    std::unique_ptr<Phase> phase_;
    std::unique_ptr<Integrator> integrator_;
};

void elastic_pendulum(CaseReport& report)
{
    constexpr double dt = 5e-4;
    const std::string test = "elastic_pendulum_m1_k100_L1_c0_theta30";
    for (const auto& [name, tolerance] :
         {std::pair{"rk4", 1e-9}, {"implicit_midpoint", 2e-5}, {"velocity_verlet", 2e-5}}) {
        ElasticPendulum pendulum(name);
        int done = 0;
        for (const char* time : {"0.5", "1", "2", "5"}) {
            for (const int until = int(std::lround(std::stod(time) / dt)); done < until; ++done) pendulum.step(dt);
            const auto compare = [&](const char* quantity, const char* unit, double measured) {
                const std::string key = fmt::format("{}({})", quantity, time);
                report.absolute(fmt::format("{}, dt {:g}: elastic pendulum, {} [{}]", name, dt, key, unit),
                                oscillation_reference(test, key), measured, tolerance);
            };
            compare("x", "m", pendulum.x());
            compare("y", "m", pendulum.y());
            compare("E", "J", pendulum.energy());
        }
    }
}

// Compares the mean energies at the start and at the end of 1e5 steps of a motion far beyond the linear range.
void long_run(CaseReport& report)
{
    Oscillator oscillator("velocity_verlet", 10, 0, 0.3);
    constexpr int count = 100000, window = 5000;
    double first = 0, last = 0;
    for (int k = 0; k < count; ++k) {
        oscillator.step(0.01);
        if (k < window) first += oscillator.energy() / window;
        if (k >= count - window) last += oscillator.energy() / window;
    }
    report.from("a symplectic scheme keeps its energy");
    report.relative("velocity_verlet, 1e5 steps: mean energy of the last 5000 steps over that of the first", 1,
                    last / first, 1e-4);
}

// A soft sheet that is free, or hangs from two corners.
struct Sheet {
    ClothModel model;
    PhaseOptions options;
    Profile profile;
    std::vector<Vec3> velocities;

    Sheet()
    {
        model.cloth = flat_rectangle(MeshFamily::alternating, 0.15, 0.15, 4);
        Fabric fabric = isotropic_fabric(20, 1e-5, 0, 0.2);
        model.fabrics = {{specimen_fabric, fabric}};
        options.params.membrane.scale = options.params.plate.scale = 1;
        options.linear.max_iterations = 2000;
    }
    Phase phase() { return Phase(model, options, nullptr, profile, model.cloth.positions, velocities); }
    void run(Phase& phase, std::string_view name, double dt, int steps)
    {
        const auto integrator = make_integrator(name, phase);
        for (int k = 0; k < steps; ++k) integrator->step(dt, exact_steps());
    }
};

// Returns the observed order of convergence: log2 of the ratio of the changes from two successive doublings of the
// number of steps. It needs no reference solution.
double observed_order(std::string_view name, int steps)
{
    std::vector<std::vector<Vec3>> ends;
    for (int k = 0; k < 3; ++k) {
        Sheet sheet;
        sheet.model.cloth.pinned = {12, 15};
        for (Vec3& x : sheet.model.cloth.positions) x = Vec3(x.x(), x.y() * 0.99, -0.1 * (0.075 - x.y()));
        sheet.options.params.gravity.acceleration_z = -9.81;
        Phase phase = sheet.phase();
        sheet.run(phase, name, 0.1 / (steps << k), steps << k);
        ends.push_back(phase.positions());
    }
    double change[2] = {};
    for (int k = 0; k < 2; ++k)
        for (std::size_t v = 0; v < ends[0].size(); ++v)
            change[k] = std::max(change[k], (ends[k + 1][v] - ends[k][v]).norm());
    return std::log2(change[0] / change[1]);
}

Vec3 momentum(const State& s, bool angular)
{
    Vec3 sum = Vec3::Zero();
    const ConstPlanes x = vertex_planes(s.size, s.pos), u = vertex_planes(s.size, s.vel);
    for (int v = 0; v < x.count; ++v) sum += s.mass[v] * (angular ? Vec3(x(v).cross(u(v))) : u(v));
    return sum;
}

void free_fall(CaseReport& report, const IntegratorInfo& info)
{
    Sheet sheet;
    sheet.options.params.gravity.acceleration_z = -9.81;
    Phase phase = sheet.phase();
    // Steps above the stability limit of an explicit scheme would amplify rounding errors.
    const double mass = 0.2 * 0.15 * 0.15, dt = info.is_explicit ? 1e-3 : 1e-2;
    sheet.run(phase, info.name, dt, int(std::lround(1 / dt)));
    report.from(
        "oscillation_references.csv: free fall; first-order schemes and the first step of BDF2 make their known error");
    report.relative(fmt::format("{}: momentum after 1 s of free fall [kg m/s]", info.name), -9.81 * mass,
                    momentum(phase.state(), false).z(), 1e-9);
    if (info.name == "bdf2") return;
    const double late = info.order == 1 ? 1 + dt : 1;
    report.relative(fmt::format("{}: displacement after 1 s of free fall [m]", info.name),
                    oscillation_reference("free_fall", "y(1)") * late, phase.positions()[5].z(), 1e-9);
}

void rotation(CaseReport& report, const IntegratorInfo& info)
{
    Sheet sheet;
    const Vec3 spin(0, 0, 5), drift(0.1, 0.2, 0.3), middle(0.075, 0, 0);
    for (const Vec3& x : sheet.model.cloth.positions) sheet.velocities.push_back(drift + spin.cross(x - middle));
    Phase phase = sheet.phase();
    const Vec3 linear = momentum(phase.state(), false), angular = momentum(phase.state(), true);
    const double energy = phase.system().kinetic_energy();
    sheet.run(phase, info.name, 1e-3, 500);
    report.from("a free sheet keeps its momentum; symplectic schemes keep its spin and nearly its energy");
    report.absolute(fmt::format("{}: free spinning sheet, change of momentum, relative", info.name), 0,
                    (momentum(phase.state(), false) - linear).norm() / linear.norm(), 1e-9);
    const double turned = momentum(phase.state(), true).z();
    const double total = phase.system().kinetic_energy() + phase.system().potential_energy();
    // Central differences give the velocity to second order only; the other schemes lose or gain angular momentum.
    const bool keeps_spin =
        info.name == "implicit_midpoint" || info.name == "velocity_verlet" || info.name == "symplectic_euler";
    if (!keeps_spin) {
        report.inform(fmt::format("{}: free spinning sheet, angular momentum [kg m^2/s]", info.name), angular.z(),
                      turned);
        return;
    }
    report.relative(fmt::format("{}: free spinning sheet, angular momentum [kg m^2/s]", info.name), angular.z(), turned,
                    1e-8);
    if (info.name == "implicit_midpoint" || info.name == "velocity_verlet")
        report.relative(fmt::format("{}: free spinning sheet, energy [J]", info.name), energy, total, 1e-3);
}

// Joining sewn vertices to one particle must conserve mass, momentum and the centre of mass.
void joining(CaseReport& report)
{
    Cloth cloth = flat_rectangle(MeshFamily::irregular, 0.3, 0.2, 7);
    const int vertices = int(cloth.positions.size());
    std::vector<Vec3> velocities;
    for (int v = 0; v < vertices; ++v) {
        cloth.positions[v] += 0.01 * Vec3(std::sin(3.0 * v), std::cos(5.0 * v), std::sin(7.0 * v));
        velocities.emplace_back(std::cos(2.0 * v), std::sin(4.0 * v), 1 + std::cos(6.0 * v));
    }
    cloth.seam_pairs = {{0, 6}, {7, 13}, {14, 20}, {1, vertices - 1}};
    const FabricTable fabrics = {{specimen_fabric, isotropic_fabric(10, 1e-5, 0, 0.2)}};
    Params params;
    params.membrane.scale = 1;
    Vec3 centre[2], total[2];
    for (const bool joined : {false, true}) {
        const State s = make_state(make_topology(cloth, joined), cloth, fabrics, params, cloth.positions, velocities);
        centre[joined] = total[joined] = Vec3::Zero();
        for (int v = 0; v < s.size.vertex_count; ++v) {
            centre[joined] += s.mass[v] * vertex_planes(s.size, s.pos)(v);
            total[joined] += s.mass[v] * vertex_planes(s.size, s.vel)(v);
        }
    }
    report.from("conservation of mass and momentum");
    report.absolute("seams join: change of momentum, relative", 0, (total[1] - total[0]).norm() / total[0].norm(),
                    1e-12);
    report.absolute("seams join: change of the centre of mass, relative", 0,
                    (centre[1] - centre[0]).norm() / centre[0].norm(), 1e-12);
}

}  // namespace

void check_integrators(CaseReport& report)
{
    report.from("oscillation_references.csv: closed forms of each scheme");
    step_factors(report);
    report.from("oscillation_references.csv: closed form");
    damped(report);
    report.from("oscillation_references.csv: elastic pendulum, integrated in many digits");
    elastic_pendulum(report);
    long_run(report);
    for (const IntegratorInfo& info : integrators()) {
        if (info.order == 0) continue;
        report.from("theory of the scheme");
        report.absolute(fmt::format("{}: observed order", info.name), info.order,
                        observed_order(info.name, info.is_explicit  ? 100
                                                  : info.order == 1 ? 1600
                                                                    : 200),
                        0.15);
        free_fall(report, info);
        rotation(report, info);
    }
    joining(report);
}

}  // namespace selvage
