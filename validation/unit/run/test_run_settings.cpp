#include <fmt/format.h>

#include "host/scene/run_settings.hpp"
#include "io/scene/read_scene.hpp"
#include "io/scene/scene.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;

namespace {

std::string chosen(const std::string& scene, const std::vector<std::string>& overrides)
{
    const Scene read = read_scene(scene, overrides);
    return text_of(integrator_of(read, build_scene_model(read).cloth_model));
}

}  // namespace

TEST_CASE("the automatic integrator is static only where the shape at rest does not depend on the motion before it")
{
    CHECK(chosen("builtin:hanging", {}) == "static");
    CHECK(chosen("builtin:hanging", {"bending.hysteresis=true"}) == "implicit_euler");
    CHECK(chosen("builtin:hanging", {"solver.adaptive=true"}) == "implicit_euler");
    CHECK(chosen("builtin:cusick", {}) == "implicit_euler");
    CHECK(chosen("builtin:tshirt", {}) == "bdf2");
    CHECK(chosen("builtin:sphere", {"solver.until=equilibrium"}) == "bdf2");
    CHECK(chosen("builtin:sphere", {"solver.until=equilibrium", "bending.hysteresis=true"}) == "implicit_euler");
    CHECK(chosen("builtin:stress_raise_arms", {"solver.until=equilibrium"}) == "implicit_euler");  // the body moves
}

TEST_CASE(
    "the automatic integrator of a motion is bdf2, for limp cloth among bodies implicit Euler, and a named one as "
    "named")
{
    CHECK(chosen("builtin:hanging", {"solver.until=0.5"}) == "bdf2");
    CHECK(chosen("builtin:sphere", {}) == "implicit_euler");
    CHECK(chosen("builtin:sphere", {"sheet.width=0.05", "sheet.height=0.05", "sheet.fabric=leather"}) == "bdf2");
    CHECK(chosen("builtin:sphere", {"solver.integrator=rk4"}) == "rk4");
    CHECK(chosen("builtin:hanging", {"solver.integrator=implicit_euler"}) == "implicit_euler");
}

TEST_CASE("the integrators of a drape name the one that takes over on the way to rest")
{
    using Names = std::vector<std::string>;
    const auto names = [](const std::string& scene, const std::vector<std::string>& overrides) {
        const Scene read = read_scene(scene, overrides);
        return drape_integrators(read, build_scene_model(read).cloth_model);
    };
    const std::string rest = "solver.until=equilibrium";
    CHECK(names("builtin:sphere", {rest}) == Names{"bdf2", "implicit_euler"});
    CHECK(names("builtin:sphere", {rest, "solver.integrator=implicit_midpoint"}) ==
          Names{"implicit_midpoint", "implicit_euler"});
    CHECK(names("builtin:sphere", {rest, "solver.integrator=bdf2"}) == Names{"bdf2"});
    CHECK(names("builtin:sphere", {rest, "solver.load_steps=3"}) == Names{"implicit_euler"});
    CHECK(names("builtin:sphere", {}) == Names{"implicit_euler"});
    CHECK(names("builtin:hanging", {}) == Names{"static"});
}

TEST_CASE("the narrowest triangle of a mesh is told, with what it does to contact beside it")
{
    // Columns of 3 cm, 30 um and 10 um: some vertices without a common triangle are nearer than cotton is thick.
    const double columns[] = {0, 0.03, 0.03003, 0.06, 0.06001, 0.09};
    std::string mesh;
    for (int j = 0; j < 6; ++j)
        for (const double x : columns) mesh += fmt::format("v {} {} 0\nvt {} {}\n", x, 0.02 * j, x, 0.02 * j);
    for (int a = 1; a < 30; ++a)
        if (a % 6 != 0)
            mesh += fmt::format("f {0}/{0} {1}/{1} {2}/{2}\nf {0}/{0} {2}/{2} {3}/{3}\n", a, a + 1, a + 7, a + 6);
    const ScratchFolder folder;
    folder.write("slivers.obj", mesh);
    const std::string file = folder.write("scene.toml", "[[sheet]]\nshape = \"mesh\"\nmesh = \"slivers.obj\"\n");
    const Scene scene = read_scene(file, std::vector<std::string>{});
    const SceneModel model = build_scene_model(scene);
    REQUIRE(!model.findings.empty());
    CHECK_THAT(describe(model.findings[0]), contains_text("1e-05 m high"));
    CHECK_THAT(describe(model.findings[0]), contains_text("cloth beside it presses"));
}
