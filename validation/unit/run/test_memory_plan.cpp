#include "host/scene/plan.hpp"
#include "host/scene/run_settings.hpp"
#include "host/solver/stepping/phase.hpp"
#include "io/scene/read_scene.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

Scene scene_of(const std::string& name, const std::vector<std::string>& overrides)
{
    return read_scene("builtin:" + name, overrides);
}

double as_planned(std::size_t planned, std::size_t held) { return double(planned) / double(held); }

}  // namespace

TEST_CASE("the plan counts the bytes that state and linear solver then hold")
{
    const auto name = GENERATE("hanging", "sphere", "vest");
    const auto precision = GENERATE("float", "double");
    const auto preconditioner = GENERATE("multigrid", "block_jacobi");
    CAPTURE(name, precision, preconditioner);
    const bool sews = std::string(name) == "vest";
    const Scene scene = scene_of(
        name, {sews ? "garment.resolution=0.04" : "sheet.resolution=33", std::string("solver.precision=") + precision,
               std::string("solver.preconditioner=") + preconditioner});
    const SceneModel model = build_scene_model(scene);
    const RunPlan plan = make_plan(scene, model);
    const PhasePlan& planned = plan.phases.back();
    const PhaseOptions options = phase_options(scene, model, false);
    Profile profile;
    BodyQuery query(model.cloth_model.bodies, cloth_reach(model.cloth_model.cloth));
    Phase phase(model.cloth_model, options, meets_bodies(options.params) ? &query : nullptr, profile,
                model.cloth_model.cloth.positions, {});
    phase.system().evaluate_stiffness(true, 0);
    phase.linear().assemble(phase.state(), 1e4);
    CHECK(as_planned(planned.solver_bytes, phase.linear().bytes()) == Approx(1).margin(0.03));
    // Pairs and corners of bodies come later. Couplings of plates are counted as on the fullest meshes.
    mesh_sizes held = phase.state().size;
    for (int* size : {&held.pair_count, &held.pair_stride, &held.pair_slot_count, &held.pair_slot_stride,
                      &held.body_point_count, &held.body_point_stride})
        *size = 0;
    const double state = as_planned(planned.field_bytes, field_bytes(held, phase.state().wanted));
    CHECK(state > 0.98);
    CHECK(state < 1.4);
}

TEST_CASE("the parts of the plan's memory add up to its peak, and large bodies count")
{
    const Scene small = scene_of("sphere", {"sheet.resolution=17", "output.picture=false"});
    const RunPlan plan = make_plan(small, build_scene_model(small));
    CHECK(total_bytes(plan.memory) == plan.peak_bytes);

    ClothModel model = build_scene_model(small).cloth_model;
    const std::size_t without = total_bytes(end_memory(small, model));
    model.bodies.push_back(model.bodies.front());
    model.bodies.back().mesh.faces.resize(1000000, {0, 1, 2});
    CHECK(total_bytes(end_memory(small, model)) > without + 1000000 * 50);
}
