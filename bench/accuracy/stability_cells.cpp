#include "bench/accuracy/stability_cells.hpp"

#include <cmath>

#include <fmt/format.h>

#include "bench/harness/scatter.hpp"
#include "bench/harness/scene_runner.hpp"
#include "host/mesh/self_intersections.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

// The limits by which a cell is judged, and its start. All were chosen by hand unless a reason is given.
struct StabilityTuning {
    static constexpr double longest_cell = 20;  // CPU time after which a cell is stopped [s]
    static constexpr double longest_step = 60;  // CPU time of one step above which it counts as hung [s]
    static constexpr double hurled_speed = 20;  // downward speed of a hurled sheet [m/s]
    // Largest accepted ratio of the final to the initial energy [1]. Near their stability limit the energy of
    // symplectic schemes oscillates by a fifth; the energy of an unstable scheme grows without bound.
    static constexpr double energy_ratio = 1.5;
};

std::vector<std::string> overrides_of(const StabilityCell& cell, bool body)
{
    return {fmt::format("sheet.resolution={}", cell.resolution),   "sheet.fabric=cotton",
            fmt::format("fabric.cotton.damping={}", cell.damping), fmt::format("membrane.scale={}", cell.stiffness),
            fmt::format("bending.scale={}", cell.stiffness),       fmt::format("contact.body={}", body),
            fmt::format("contact.self={}", cell.self_contact)};
}

int crossings(const SceneRunner& runner, const Phase& phase, const StabilityCell& cell)
{
    return cell.self_contact ? int(self_intersections(phase.positions(), runner.model().cloth_model.cloth.faces).size())
                             : 0;
}

void begin(ViolentStart kind, double spacing, State& state)
{
    const int vs = state.size.vertex_stride;
    for (int v = 0; v < state.size.vertex_count; ++v)
        for (int c = 0; c < 3; ++c) {
            real& x = state.pos[c * vs + v];
            if (kind == ViolentStart::crumpled)
                x += 0.4 * spacing * scatter(3 * std::uint64_t(v) + c) + (c == 2 ? spacing : 0);
            if (kind == ViolentStart::stretched && c < 2) x *= 1.5;
            if (kind == ViolentStart::hurled && c == 2) {
                x += 0.3;
                state.vel[c * vs + v] = -StabilityTuning::hurled_speed;
            }
        }
}

int step_count(const StabilityCell& cell) { return cell.resolution > 32 ? 4 : 10; }

double total_energy(Phase& phase) { return phase.system().potential_energy() + phase.system().kinetic_energy(); }

// The potential energy that gravity can supply [J], from a fall of the given time and start speed plus 1 m.
double gravity_reserve(const State& state, const Params& params, double time, double speed)
{
    double mass = 0;
    for (int v = 0; v < state.size.vertex_count; ++v) mass += state.mass[v];
    const double g = std::abs(params.gravity.acceleration_z), fall = speed * time + 0.5 * g * time * time + 1;
    return mass * g * fall;
}

// Takes the steps of a cell. Returns whether all of them had the requested length.
bool take_steps(Phase& phase, const StabilityCell& cell, StabilityResult& result)
{
    const auto integrator = make_integrator(cell.integrator, phase);
    StepOptions steps;
    steps.longest = cell.step;
    steps.unstable = UnstableStep::refuse;
    StepControl control(phase, *integrator, steps);
    NewtonOptions newton;
    newton.max_iterations = 40;
    newton.velocity_tolerance = 3e-2;
    const double start = thread_seconds(), until = step_count(cell) * cell.step;
    for (double time = 0; time < until * (1 - 1e-9);) {
        const double before = result.seconds;
        time += control.advance(until - time, newton, true);
        result.seconds = thread_seconds() - start;
        if (result.seconds > StabilityTuning::longest_cell) {
            const bool hung = result.seconds - before > StabilityTuning::longest_step;
            result.verdict = hung ? StabilityVerdict::hung : StabilityVerdict::slow;
            return false;
        }
    }
    return control.retries() == 0;
}

bool is_finite(const State& state)
{
    double sum = 0;
    for (real x : state.pos) sum += x * x;
    for (real v : state.vel) sum += v * v;
    return std::isfinite(sum);
}

// Whether small random velocities grow when an explicit integrator takes steps dt, that is, dt is above its limit.
bool grows(SceneRunner& runner, const std::string& integrator_name, double dt)
{
    Phase phase = runner.make_phase(false);
    State& state = phase.state();
    // The ripple of the scene's start is removed: a flat sheet is in equilibrium, so only the velocities move it.
    std::fill_n(state.pos.begin() + 2 * state.size.vertex_stride, state.size.vertex_count, 0.27);
    for (int v = 0; v < state.size.vertex_count; ++v)
        for (int c = 0; c < 3; ++c)
            state.vel[c * state.size.vertex_stride + v] = 1e-9 * scatter(3 * std::uint64_t(v) + c);
    const auto integrator = make_integrator(integrator_name, phase);
    const double before = phase.system().kinetic_energy();
    for (int step = 0; step < 2000; ++step) {
        integrator->step(dt, {});
        if (step % 50 == 49 && !(phase.system().kinetic_energy() < 1e4 * before)) return true;
    }
    return false;
}

}  // namespace

const char* name_of(ViolentStart start)
{
    constexpr const char* names[] = {"crumpled", "stretched", "hurled"};
    return names[int(start)];
}

const char* name_of(StabilityVerdict verdict)
{
    constexpr const char* names[verdict_count] = {"stable", "recovered", "refused", "gave up",
                                                  "slow",   "hung",      "garbage"};
    return names[int(verdict)];
}

std::vector<StabilityCell> stability_cells(bool quick)
{
    struct Grid {
        int resolution;
        std::vector<double> steps, stiffness, damping;
        bool self_contact = false;
    };
    const std::vector<double> fine = {1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1};
    std::vector<Grid> grids = {{16, fine, {0.01, 0.1, 1, 10, 100}, {0, 5}},
                               {16, {1e-4, 1e-3, 1e-2, 1e-1}, {0.01, 1, 100}, {0}, true},
                               {32, {1e-5, 1e-4, 1e-3, 1e-2, 1e-1}, {0.01, 1, 100}, {0, 5}},
                               {64, {1e-5, 1e-3, 1e-1}, {0.01, 1, 100}, {0}},
                               {128, {1e-4, 1e-2}, {1}, {0}}};
    if (quick) grids.resize(1);
    std::vector<StabilityCell> cells;
    for (const Grid& grid : grids)
        for (const IntegratorInfo& info : integrators()) {
            if (info.order == 0) continue;
            for (double stiffness : grid.stiffness)
                for (double damping : grid.damping)
                    for (ViolentStart start : {ViolentStart::crumpled, ViolentStart::stretched, ViolentStart::hurled})
                        for (double step : grid.steps)
                            cells.push_back({std::string(info.name), step, stiffness, grid.resolution, damping, start,
                                             grid.self_contact});
        }
    return cells;
}

StabilityResult run_cell(const StabilityCell& cell)
{
    StabilityResult result;
    result.cell = cell;
    SceneRunner runner("builtin:sphere", overrides_of(cell, true));
    Phase phase = runner.make_phase(true);
    begin(cell.start, runner.model().edge_length, phase.state());
    phase.system().find_contacts();
    result.tangled = crossings(runner, phase, cell);
    const double speed = cell.start == ViolentStart::hurled ? StabilityTuning::hurled_speed : 0;
    const double reserve = gravity_reserve(phase.state(), phase.params(), step_count(cell) * cell.step, speed);
    const double before = total_energy(phase) + reserve;
    try {
        const bool as_asked = take_steps(phase, cell, result);
        if (result.verdict == StabilityVerdict::stable)
            result.verdict = as_asked ? StabilityVerdict::stable : StabilityVerdict::recovered;
    } catch (const UnstableStepError& error) {
        result.verdict = StabilityVerdict::refused;
        result.message = error.what();
    } catch (const DivergenceError& error) {
        result.verdict = StabilityVerdict::gave_up;
        result.message = error.what();
    }
    result.energy_ratio = (total_energy(phase) + reserve) / before;
    // The state must be sound even after a run that gave up, because it is the last good state.
    const bool sound = is_finite(phase.state()) && result.energy_ratio <= StabilityTuning::energy_ratio;
    if (sound) result.crossed = crossings(runner, phase, cell);
    // Cloth that intersects itself from the start may still do so at the end.
    if (!sound || (result.tangled == 0 && result.crossed > 0)) result.verdict = StabilityVerdict::garbage;
    return result;
}

LimitResult measure_limit(const std::string& integrator, double stiffness, int resolution)
{
    std::vector<std::string> overrides =
        overrides_of({integrator, 0, stiffness, resolution, 0, ViolentStart::stretched}, false);
    overrides.push_back("solver.gravity=[0,0,0]");
    SceneRunner runner("builtin:sphere", overrides);
    LimitResult result{integrator, stiffness, resolution, 0, 0};
    {
        Phase phase = runner.make_phase(false);
        result.predicted = make_integrator(integrator, phase)->stable_step();
    }
    double low = 0.5, high = 2;
    while (high - low > 0.005) {
        const double middle = 0.5 * (low + high);
        (grows(runner, integrator, middle * result.predicted) ? high : low) = middle;
    }
    result.measured = 0.5 * (low + high) * result.predicted;
    return result;
}

}  // namespace selvage
