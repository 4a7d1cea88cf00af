#include <catch2/catch.hpp>

#include "host/scene_phase.hpp"
#include "io/scene.hpp"

using namespace selvage;

namespace {

std::string chosen(const std::string& scene, const std::vector<std::string>& overrides)
{
    return integrator_of(read_scene(scene, overrides));
}

}  // namespace

TEST_CASE("the automatic integrator goes straight to rest only where the way there does not matter")
{
    CHECK(chosen("builtin:hanging", {}) == "static");
    CHECK(chosen("builtin:hanging", {"bending.hysteresis=true"}) == "implicit_euler");
    CHECK(chosen("builtin:hanging", {"solver.adaptive=true"}) == "implicit_euler");
    CHECK(chosen("builtin:cusick", {}) == "implicit_euler");
    CHECK(chosen("builtin:tshirt", {}) == "implicit_euler");
}

TEST_CASE("the automatic integrator of a motion is bdf2, and a named one is taken as named")
{
    CHECK(chosen("builtin:hanging", {"solver.until=0.5"}) == "bdf2");
    CHECK(chosen("builtin:sphere", {}) == "bdf2");
    CHECK(chosen("builtin:sphere", {"solver.integrator=rk4"}) == "rk4");
    CHECK(chosen("builtin:hanging", {"solver.integrator=implicit_euler"}) == "implicit_euler");
}
