#include "bench/accuracy/stability_cells.hpp"
#include "bench/harness/scene_runner.hpp"
#include "host/solver/stepping/step_control.hpp"
#include "io/errors.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

TEST_CASE(
    "soft sheets hurled at a sphere end stable, recovered, refused or given up, with at most 1.3 times their energy")
{
    for (const IntegratorInfo& info : integrators()) {
        if (!info.is_explicit) continue;
        for (const double stiffness : {0.01, 0.1})
            for (const double damping : {0.0, 5.0})
                for (const double step : {3e-3, 1e-2}) {
                    const StabilityResult result =
                        run_cell({std::string(info.name), step, stiffness, 16, damping, ViolentStart::hurled});
                    INFO(info.name << ", step " << step << ", stiffness " << stiffness << ", damping " << damping);
                    CHECK(name_of(result.verdict) != std::string(name_of(StabilityVerdict::garbage)));
                    CHECK(result.energy_ratio < 1.3);
                }
    }
}

TEST_CASE("a sheet that starts without self-intersections ends without, however violent the start")
{
    for (const char* integrator : {"implicit_euler", "bdf2", "implicit_midpoint", "velocity_verlet"})
        for (const ViolentStart start : {ViolentStart::stretched, ViolentStart::hurled})
            for (const double step : {1e-3, 1e-2}) {
                const StabilityResult result = run_cell({integrator, step, 0.01, 16, 0, start, true});
                INFO(integrator << ", step " << step << ", " << name_of(start) << ", energy ratio "
                                << result.energy_ratio << " " << result.message);
                CHECK(result.tangled == 0);
                CHECK(result.crossed == 0);
                CHECK(name_of(result.verdict) != std::string(name_of(StabilityVerdict::garbage)));
            }
}

TEST_CASE("self-intersections of a violent start are counted and may remain after ten short steps")
{
    const StabilityResult result = run_cell({"implicit_euler", 1e-4, 0.01, 16, 0, ViolentStart::crumpled, true});
    CHECK(result.tangled > 0);
    CHECK(result.verdict == StabilityVerdict::stable);
}

TEST_CASE("a run that ends at the stability limit keeps its last accepted state and the contact planes of that state")
{
    SceneRunner runner("builtin:sphere", {"sheet.resolution=16", "sheet.fabric=cotton", "membrane.scale=0.01",
                                          "bending.scale=0.01", "contact.self=false"});
    Phase phase = runner.make_phase(true);
    State& state = phase.state();
    std::fill_n(state.vel.begin() + 2 * state.size.vertex_stride, state.size.vertex_count, -20.0);
    const auto integrator = make_integrator("velocity_verlet", phase);
    StepOptions options;
    options.longest = 3e-3;
    options.unstable = UnstableStep::refuse;
    StepControl control(phase, *integrator, options);
    std::vector<real> accepted = state.pos;
    bool refused = false;
    for (int step = 0; step < 20 && !refused; ++step) {
        try {
            control.advance(1, {}, true);
            accepted = state.pos;
        } catch (const UnstableStepError&) {
            refused = true;
        }
    }
    REQUIRE(refused);
    CHECK(state.pos == accepted);
    const double kept = phase.system().potential_energy();
    phase.contact()->update(state);
    CHECK(phase.system().potential_energy() == kept);
}
