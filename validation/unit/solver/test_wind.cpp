#include <cmath>

#include "host/model/air.hpp"
#include "host/scene/features.hpp"
#include "host/scene/plan.hpp"
#include "io/scene/read_scene.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

RunPlan plan_of(std::vector<std::string> overrides)
{
    overrides.insert(overrides.end(), {"sheet.resolution=9", "solver.until=1"});
    const Scene scene = read_scene("builtin:hanging", overrides);
    return make_plan(scene, build_scene_model(scene));
}

bool runs(const RunPlan& plan, std::string_view name)
{
    return std::any_of(plan.active.begin(), plan.active.end(), [&](const std::string& term) { return term == name; });
}

}  // namespace

TEST_CASE("gusts follow from time and seed alone and have the strength that is asked for", "[wind]")
{
    const Vec3 mean(5, 0, -1);
    const Air air(mean, 2, 3, 7), same(mean, 2, 3, 7), other(mean, 2, 3, 8);
    CHECK(air.velocity(1.25) == same.velocity(1.25));
    CHECK((air.velocity(1.25) - other.velocity(1.25)).norm() > 0.1);
    Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
    constexpr int count = 200000;
    for (int k = 0; k < count; ++k) {
        const Vec3 gust = air.velocity(0.05 * k) - mean;
        sum += gust;
        squares += gust.cwiseProduct(gust);
    }
    for (int axis = 0; axis < 3; ++axis) {
        CHECK(std::abs(sum[axis] / count) < 0.02);
        CHECK(std::sqrt(squares[axis] / count) == Approx(2).epsilon(0.01));
    }
    CHECK(Air(mean, 0, 3, 7).velocity(10) == mean);
}

TEST_CASE("air that neither blows nor is said to stand still costs nothing", "[wind][plan]")
{
    const RunPlan none = plan_of({}), still = plan_of({"wind.still_air=true"}),
                  wind = plan_of({"wind.velocity=[1, 0, 0]"}), gusts = plan_of({"wind.gust=1"});
    CHECK_FALSE(runs(none, "wind"));
    CHECK_FALSE(runs(none, "air_drag"));
    CHECK_FALSE(runs(still, "wind"));
    CHECK(runs(still, "air_drag"));
    for (const RunPlan* plan : {&wind, &gusts}) {
        CHECK(runs(*plan, "wind"));
        CHECK(runs(*plan, "air_drag"));
        CHECK(plan->phases.back().field_bytes > none.phases.back().field_bytes);
    }
}

TEST_CASE("gusts are refused where the cloth is to come to rest", "[wind]")
{
    CHECK_THROWS_WITH(read_scene("builtin:hanging", std::vector<std::string>{"wind.gust=1"}),
                      contains_text("wind.gust") && contains_text("solver.until"));
    CHECK_NOTHROW(read_scene("builtin:hanging", std::vector<std::string>{"wind.velocity=[2, 0, 0]"}));
}
