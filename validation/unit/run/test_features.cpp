#include <set>

#include <fmt/format.h>

#include "host/scene/features.hpp"
#include "host/scene/plan.hpp"
#include "host/solver/terms/terms.hpp"
#include "host/solver/terms/velocity_filters.hpp"
#include "io/scene/read_scene.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

Scene small_scene(const std::string& name, std::vector<std::string> overrides)
{
    overrides.emplace_back("sheet.resolution=9");
    return read_scene("builtin:" + name, overrides);
}

template <class Kernels>
void check_reasons(const Kernels& kernels, const FeatureCase& with, const Params& params)
{
    for (const auto& kernel : kernels) {
        INFO(kernel.name << ": " << why_off(with, kernel.name, params));
        CHECK(kernel.is_active(params) == why_off(with, kernel.name, params).empty());
    }
}

const PhasePlan& only_phase(const RunPlan& plan)
{
    REQUIRE(plan.phases.size() == 1);
    return plan.phases.front();
}

}  // namespace

TEST_CASE("a term or rule is off exactly where the table of features gives a reason")
{
    const auto name = GENERATE("hanging", "sphere");
    const auto membrane = GENERATE("orthotropic", "springs", "none");
    const auto bending = GENERATE("automatic", "plate", "hinge", "springs", "none");
    const auto response = GENERATE("barrier", "exponential", "velocity_rule");
    const auto scale = GENERATE("0", "1");
    const Scene scene =
        small_scene(name, {std::string("membrane.model=") + membrane, std::string("membrane.scale=") + scale,
                           std::string("bending.model=") + bending, std::string("bending.scale=") + scale,
                           std::string("contact.response=") + response, "bending.hysteresis=true"});
    const SceneModel model = build_scene_model(scene);
    for (const bool sewing : {false, true}) {
        CAPTURE(name, membrane, bending, response, scale, sewing);
        const Params params = phase_params(scene, model, sewing);
        check_reasons(all_terms(), {scene, model, sewing}, params);
        check_reasons(all_velocity_filters(), {scene, model, sewing}, params);
    }
}

TEST_CASE("no two rows of the table of features have one name")
{
    std::set<std::string_view> rows;
    for (const Feature& feature : all_features()) CHECK(rows.insert(feature.name).second);
}

TEST_CASE("a term for which the scene gives no strength is off for that reason")
{
    const Scene scene = small_scene("hanging", {"membrane.model=springs", "membrane.scale=0", "bending.scale=0"});
    const SceneModel model = build_scene_model(scene);
    CHECK(why_off({scene, model, false}, "spring", phase_params(scene, model, false)) == "its strength is zero");
}

TEST_CASE("the plan counts the matrix in the precision that the run will use")
{
    // Cloth as small as this is solved directly, and in double, unless that is asked for otherwise.
    const auto solver_bytes = [](const std::string& precision, const std::string& preconditioner = "block_jacobi") {
        const Scene scene = small_scene("hanging", {fmt::format("solver.precision={}", precision),
                                                    fmt::format("solver.preconditioner={}", preconditioner)});
        return only_phase(make_plan(scene, build_scene_model(scene))).solver_bytes;
    };
    CHECK(solver_bytes("automatic") == solver_bytes("float"));
    CHECK(solver_bytes("automatic", "auto") == solver_bytes("double"));
    CHECK(solver_bytes("float") < solver_bytes("double"));
}
