#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "host/run/run.hpp"
#include "host/solver/stepping/integrator.hpp"
#include "io/run/checkpoint.hpp"
#include "io/run/trajectory.hpp"
#include "io/scene/read_scene.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;
namespace fs = std::filesystem;

namespace {

// A small sheet falls askew on one that lies on a ball: friction, sticking and sliding pairs, folds.
constexpr const char* falling_sheets = R"(
sheet = [{width = 0.3, height = 0.3, resolution = 7, center = [0, 0, 0.112]},
         {width = 0.2, height = 0.2, resolution = 6, center = [0.05, 0.03, 0.135], rotation = [8, 0, 30]}]
body = [{shape = "sphere", radius = 0.1, center = [0, 0, 0]}]
solver = {until = 0.4}
)";

// Spheres that come together squeeze a hanging sheet, whose corners are carried aside meanwhile.
constexpr const char* squeezed_sheet = R"(
sheet = [{width = 0.4, height = 0.4, resolution = 9, center = [0, 0, 1], rotation = [90, 0, 0]}]
pins.motion = [{group = "top_corners", start = 0, end = 0.3, velocity = [0.1, 0, 0.05]}]
solver = {until = 0.35}
[[body]]
shape = "sphere"
radius = 0.1
center = [0.02, -0.16, 0.95]
keyframe = [{time = 0.25, translation = [0, 0.07, 0]}]
[[body]]
shape = "sphere"
radius = 0.1
center = [-0.02, 0.16, 0.95]
keyframe = [{time = 0.25, translation = [0, -0.07, 0]}]
)";

const std::vector<std::string> small_garment = {"garment.resolution=0.07", "solver.max_time=0.5"};

Scene scene_of(const std::string& file, std::vector<std::string> overrides)
{
    for (const char* more : {"output.picture=false", "output.checkpoint_interval=0", "output.keep_checkpoint=true",
                             "output.precision=lossless", "solver.threads=1"})
        overrides.push_back(more);
    return read_scene(file, overrides);
}

// What two runs must have in common after as many steps: all but wall times.
Checkpoint without_wall_times(Checkpoint checkpoint)
{
    checkpoint.reals.erase("wall_seconds");
    std::erase_if(checkpoint.reals, [](const auto& entry) { return entry.first.starts_with("seconds."); });
    if (auto at = checkpoint.reals.find("coarse.measures"); at != checkpoint.reals.end())
        for (std::size_t k = 1; k < at->second.size(); k += 2) at->second[k] = 0;
    return checkpoint;
}

void check_equal(const Checkpoint& resumed, const Checkpoint& whole)
{
    std::string differ;
    for (const auto& [name, values] : whole.reals)
        if (!resumed.reals.contains(name) || resumed.reals.at(name) != values) differ += name + " ";
    for (const auto& [name, values] : whole.integers)
        if (!resumed.integers.contains(name) || resumed.integers.at(name) != values) differ += name + " ";
    CHECK(differ == "");
    CHECK(resumed.words == whole.words);
    CHECK(resumed.reals.size() == whole.reals.size());
    CHECK(resumed.integers.size() == whole.integers.size());
}

void check_equal_frames(const std::string& resumed, const std::string& whole)
{
    if (!fs::exists(whole)) return;
    const TrajectoryReader a(resumed), b(whole);
    REQUIRE(a.frame_count() == b.frame_count());
    for (int k = 0; k < a.frame_count(); ++k) {
        INFO("frame " << k);
        const FrameScalars &p = a.scalars(k), &q = b.scalars(k);
        CHECK(a.read_frame(k) == b.read_frame(k));
        CHECK(p.time == q.time);
        CHECK(p.kinetic_energy == q.kinetic_energy);
        CHECK(p.total_energy == q.total_energy);
        CHECK(p.residual == q.residual);
        CHECK(p.contacts == q.contacts);
        CHECK(p.iterations == q.iterations);
    }
}

// Runs a scene with a checkpoint after each step, and resumes it from every `stride`-th of them: the next checkpoints
// must be equal, and from the one in the middle all to the end, and all frames.
void check_resumed_runs(const std::string& file, const std::vector<std::string>& overrides, int stride)
{
    constexpr int ahead = 2;
    const ScratchFolder scratch;
    const Scene scene = scene_of(file, overrides);
    RunOptions options{.folder = scratch.path("whole"), .quiet = true};
    const auto copy_of = [&](int k) { return scratch.path(fmt::format("part{}", k)); };
    std::vector<Checkpoint> steps;
    options.after_checkpoint = [&] {
        if (int(steps.size()) % stride == 0) fs::copy(options.folder, copy_of(int(steps.size())));
        steps.push_back(without_wall_times(read_checkpoint(options.folder + "/checkpoint.h5")));
        return true;
    };
    const RunOutcome outcome = run_drape(scene, options);
    REQUIRE(steps.size() > 10);
    for (int k = 0; k < int(steps.size()); k += stride) {
        INFO("resumed from checkpoint " << k << " of " << steps.size() << ", stage " << steps[k].words.at("phase"));
        const bool whole = k / stride == int(steps.size()) / stride / 2;
        RunOptions part{.folder = copy_of(k), .resume = true, .quiet = true};
        int at = k;
        part.after_checkpoint = [&] {
            if (++at < int(steps.size()) && (whole || at <= k + ahead))
                check_equal(without_wall_times(read_checkpoint(part.folder + "/checkpoint.h5")), steps[at]);
            return whole || at < k + ahead;
        };
        const RunOutcome end = run_drape(scene, part);
        CHECK(at >= std::min(whole ? int(steps.size()) : k + ahead, int(steps.size()) - 1));
        if (!whole) continue;
        CHECK(end.status == outcome.status);
        check_equal_frames(part.folder + "/run.h5", options.folder + "/run.h5");
        check_equal_frames(part.folder + "/sewing.h5", options.folder + "/sewing.h5");
    }
}

}  // namespace

TEST_CASE("cloth that touches itself goes on bit for bit from the checkpoint of any step, whatever the integrator")
{
    const ScratchFolder scratch;
    const std::string scene = scratch.write("sheets.toml", falling_sheets);
    for (const IntegratorInfo& info : integrators()) {
        INFO(info.name);
        const std::string integrator = "solver.integrator=" + std::string(info.name);
        if (info.order == 0)
            check_resumed_runs(scene, {integrator, "solver.until=equilibrium"}, 9);
        else if (info.is_explicit)
            check_resumed_runs(scene, {integrator, "solver.step=0.004", "solver.until=0.1"}, 9);
        else
            check_resumed_runs(scene, {integrator, "solver.step=0.02", "solver.until=0.3"}, 6);
    }
}

TEST_CASE("so it does on its way to rest, asleep in places and between static attempts, and with steps that adapt")
{
    const ScratchFolder scratch;
    const std::string scene = scratch.write("sheets.toml", falling_sheets);
    check_resumed_runs(scene, {"solver.until=equilibrium"}, 17);
    check_resumed_runs(scene, {"solver.until=equilibrium", "solver.integrator=bdf2"}, 17);
    check_resumed_runs(scene, {"solver.until=0.1", "solver.adaptive=true", "solver.integrator=bdf2"}, 9);
}

TEST_CASE("so does cloth between bodies and pins that move")
{
    const ScratchFolder scratch;
    const std::string scene = scratch.write("squeeze.toml", squeezed_sheet);
    for (const char* integrator : {"implicit_euler", "bdf2"}) {
        INFO(integrator);
        check_resumed_runs(scene, {fmt::format("solver.integrator={}", integrator), "solver.until=0.25"}, 6);
    }
}

TEST_CASE("so does a flag in gusts")
{
    check_resumed_runs("builtin:flag", {"sheet.resolution=7", "solver.until=0.4"}, 7);
}

TEST_CASE("so does a garment while it is sewn, pressed and draped")
{
    check_resumed_runs("builtin:vest", small_garment, 37);
}

TEST_CASE("so does a sheet that is draped on coarser meshes first")
{
    check_resumed_runs("builtin:hanging", {"sheet.resolution=33"}, 2);
}

TEST_CASE("a run that goes on waits for its next checkpoint as long as one that was left alone")
{
    const ScratchFolder scratch;
    const std::string file = scratch.write("sheets.toml", falling_sheets);
    int checkpoints = 0;
    RunOptions options{.folder = scratch.path("out"), .quiet = true};
    options.after_checkpoint = [&] { return ++checkpoints < 3; };
    run_drape(scene_of(file, {"solver.until=0.3"}), options);
    REQUIRE(checkpoints >= 3);
    const std::string path = options.folder + "/checkpoint.h5";
    Checkpoint late = read_checkpoint(path);
    late.reals.at("wall_seconds") = {7000};
    write_checkpoint(path, late);
    checkpoints = 0;
    options.resume = true;
    options.after_checkpoint = [&] { return ++checkpoints > 0; };
    Scene scene = scene_of(file, {"solver.until=0.3"});
    scene.output.checkpoint_interval = 3600;
    CHECK(run_drape(scene, options).status == RunStatus::finished);
    CHECK(checkpoints == 1);  // at the end
}
