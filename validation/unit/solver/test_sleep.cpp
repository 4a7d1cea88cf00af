#include "host/scene/run_settings.hpp"
#include "host/scene/scene_model.hpp"
#include "host/solver/stepping/sleep.hpp"
#include "io/scene/read_scene.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

// A sheet that hangs by its top corners. The solver works in double precision, so that two ways of computing the same
// step agree closely.
Scene hanging()
{
    const std::vector<std::string> changes{"sheet.resolution=17", "solver.precision=double"};
    return read_scene("builtin:hanging", changes);
}

struct Cloths {
    SceneModel model;
    Profile profile;
    std::unique_ptr<Phase> phase;

    explicit Cloths(const Scene& scene) : model(build_scene_model(scene))
    {
        const Cloth& cloth = model.cloth_model.cloth;
        phase = std::make_unique<Phase>(model.cloth_model, phase_options(scene, model, false), nullptr, profile,
                                        cloth.positions, std::vector<Vec3>{});
    }
};

NewtonOptions exact()
{
    NewtonOptions options;
    options.max_iterations = 20;
    options.tolerance = 1e-9;
    options.linear_tolerance = 1e-8;
    return options;
}

// Marks the vertices of the sheet that are put to sleep.
std::vector<char> lower_half(const Cloth& cloth)
{
    std::vector<char> result;
    for (const Vec2& u : cloth.panel_coordinates) result.push_back(u.y() < 0);
    return result;
}

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double most = 0;
    for (std::size_t v = 0; v < a.size(); ++v) most = std::max(most, (a[v] - b[v]).norm());
    return most;
}

}  // namespace

TEST_CASE("cloth of which a part sleeps moves as if that part were pinned")
{
    const Scene scene = hanging();
    Cloths sleeping(scene), pinned(scene);
    const std::vector<Vec3> start = sleeping.model.cloth_model.cloth.positions;
    const std::vector<char> asleep = lower_half(sleeping.model.cloth_model.cloth);
    std::vector<char> awake;
    for (char s : asleep) awake.push_back(!s);
    // The vertices are pinned only after the phase was made. Pinned before, they would clamp the plate, whose elements
    // would then differ from those of the sleeping sheet.
    for (std::size_t v = 0; v < asleep.size(); ++v)
        if (asleep[v]) pinned.phase->state().inv_mass[v] = 0;

    sleeping.phase->system().evaluate_forces(false);
    put_to_sleep(sleeping.phase->system(), awake, 0);
    CHECK(sleeping.phase->state().awake.face.size() < sleeping.model.cloth_model.cloth.faces.size());
    for (int step = 0; step < 3; ++step) {
        REQUIRE(implicit_euler_step(sleeping.phase->newton(), 0.02, exact()).converged);
        REQUIRE(implicit_euler_step(pinned.phase->newton(), 0.02, exact()).converged);
    }
    const std::vector<Vec3> a = sleeping.phase->positions(), b = pinned.phase->positions();
    CHECK(largest_difference(a, b) < 1e-8);
    CHECK(largest_difference(a, start) > 1e-4);
    for (std::size_t v = 0; v < asleep.size(); ++v)
        if (asleep[v]) CHECK(a[v] == start[v]);
}

TEST_CASE("once all vertices are awake the forces and energy are those of a sheet that never slept")
{
    const Scene scene = hanging();
    Cloths slept(scene), other(scene);
    std::vector<char> awake;
    for (char s : lower_half(slept.model.cloth_model.cloth)) awake.push_back(!s);
    slept.phase->system().evaluate_forces(false);
    put_to_sleep(slept.phase->system(), awake, 0);
    implicit_euler_step(slept.phase->newton(), 0.02, exact());
    wake(slept.phase->system());
    other.phase->state().pos = slept.phase->state().pos;
    other.phase->state().vel = slept.phase->state().vel;
    CHECK(slept.phase->system().residual() == Approx(other.phase->system().residual()).epsilon(1e-12));
    CHECK(slept.phase->system().potential_energy() == Approx(other.phase->system().potential_energy()).epsilon(1e-12));
    REQUIRE(implicit_euler_step(slept.phase->newton(), 0.02, exact()).converged);
    REQUIRE(implicit_euler_step(other.phase->newton(), 0.02, exact()).converged);
    CHECK(largest_difference(slept.phase->positions(), other.phase->positions()) < 1e-9);
}
