#include <climits>
#include <fstream>
#include <iterator>
#include <limits>

#include "bench/harness/scene_runner.hpp"
#include "host/run/phase_memory.hpp"
#include "host/run/restart.hpp"
#include "host/solver/state/snapshot.hpp"
#include "io/errors.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;

namespace {

// A small phase with an integrator that remembers.
struct Run {
    SceneRunner runner{"builtin:sphere", {"sheet.resolution=6", "contact.self=false"}};
    Phase phase = runner.make_phase(true);
    std::unique_ptr<Integrator> integrator = make_integrator("bdf2", phase);

    void fill_kept(double start)
    {
        visit_kept(phase.state(), [&](std::string_view, std::vector<real>& field) {
            for (real& number : field) number = start += 0.001;
        });
        for (const HistoryArray& array : integrator->history())
            for (real& number : *array.values) number = start += 0.001;
    }
};

RunIdentity some_identity() { return {{{"solver.step", "0.02"}, {"solver.until", "2"}}, "0123", {}, 50, 3}; }

RunProgress some_progress()
{
    RunProgress p;
    p.stage = RunStage::drape;
    p.sewing = {{1, 0, 1}, 3, 4, 5, 0.2, true, 0.3, 6, 7, 0.4, 0.5, {0.7}};
    p.pressing = {8, {0.9}};
    p.draping = {1.2, 13, 1.4, {1.5, 1, 1.6, 1.7, 1.8}, 16, 0};
    p.counters = {17,
                  18,
                  19,
                  2.1,
                  {{"drape", 2.2}, {"sew", 2.3}},
                  {"bdf2", "implicit_euler"},
                  {50, 1, 0.011, 1.2, 0.3, 51, 0.012, 1.3, 0.4},
                  {0.3, 49, 1.1}};
    p.frame = {26, true};
    p.stability = {2.7, 2.8, 2.9};
    p.ended = true;
    p.wall_seconds = 2.4;
    p.frames = 25;
    return p;
}

// A run that has been saved, and what it saved.
struct SavedRun {
    ScratchFolder folder;
    std::string path = folder.path("checkpoint.h5");
    Run run;
    Checkpoint checkpoint = save();

    Checkpoint save(const RunProgress& progress = some_progress())
    {
        save_run(path, some_identity(), progress, run.phase, *run.integrator);
        return read_checkpoint(path);
    }
    void load(const Checkpoint& other)
    {
        load_progress(other, path, some_identity());
        load_phase(other, path, run.phase, *run.integrator);
    }
};

}  // namespace

TEST_CASE("every kept field, the time and all that the integrator remembers come back from a checkpoint bit for bit")
{
    const ScratchFolder folder;
    const std::string path = folder.path("checkpoint.h5");
    Run run, other;
    run.fill_kept(1);
    run.phase.system().clock().time = 0.1;
    save_run(path, some_identity(), some_progress(), run.phase, *run.integrator);
    other.fill_kept(-7);
    const Checkpoint checkpoint = read_checkpoint(path);
    load_phase(checkpoint, path, other.phase, *other.integrator);

    CHECK(other.phase.system().clock().time == 0.1);
    std::vector<std::vector<real>> fields;
    visit_kept(run.phase.state(), [&](std::string_view, const std::vector<real>& field) { fields.push_back(field); });
    REQUIRE_FALSE(fields.empty());
    std::size_t k = 0;
    visit_kept(other.phase.state(), [&](std::string_view name, const std::vector<real>& field) {
        INFO(name);
        CHECK(field == fields[k++]);
    });
    const std::vector<HistoryArray> history = run.integrator->history();
    for (std::size_t h = 0; h < history.size(); ++h) {
        INFO(history[h].name);
        CHECK(*other.integrator->history()[h].values == *history[h].values);
    }
}

TEST_CASE("progress that is loaded and saved again leaves the same checkpoint")
{
    SavedRun saved;
    const Checkpoint first = saved.checkpoint;
    const Checkpoint second = saved.save(load_progress(first, saved.path, some_identity()));
    CHECK(first.reals == second.reals);
    CHECK(first.integers == second.integers);
    CHECK(first.words == second.words);
    CHECK(first.integers.at("draping.hold") == std::vector<int>{13});
    CHECK(first.reals.at("seconds.sew") == std::vector<double>{2.3});
}

TEST_CASE("a checkpoint that lacks any of its entries is refused by that entry's name")
{
    SavedRun saved;
    const Checkpoint whole = saved.checkpoint;
    const auto check_refused = [&](const Checkpoint& part, const std::string& name) {
        INFO(name);
        std::string message;
        try {
            saved.load(part);
        } catch (const InputError& error) {
            message = error.what();
        }
        CHECK(message.find(name) != std::string::npos);
    };
    for (const auto& [name, values] : whole.reals) {
        if (name.starts_with("seconds.")) continue;  // of the phases that there have been
        Checkpoint part = whole;
        part.reals.erase(name);
        check_refused(part, name);
    }
    for (const auto& [name, values] : whole.integers) {
        Checkpoint part = whole;
        part.integers.erase(name);
        check_refused(part, name);
    }
}

TEST_CASE("a checkpoint of another scene is refused by the keys that differ, but for those that may change")
{
    const SavedRun saved;
    const Checkpoint& checkpoint = saved.checkpoint;
    const std::string& path = saved.path;
    RunIdentity longer = some_identity(), finer = some_identity(), newer = some_identity();
    longer.scene["solver.until"] = "3";
    CHECK(load_progress(checkpoint, path, longer).frames == 25);
    finer.scene["solver.step"] = "0.01";
    CHECK_THROWS_WITH(load_progress(checkpoint, path, finer),
                      contains_text("solver.step is `0.01`, was `0.02`") && !contains_text("solver.until"));
    newer.scene["fabric.cotton.thickness"] = "0.0003";
    CHECK_THROWS_WITH(load_progress(checkpoint, path, newer),
                      contains_text("fabric.cotton has keys that were not there"));
}

TEST_CASE("a checkpoint is refused when any of its bits has changed, or when it is cut")
{
    const ScratchFolder folder;
    const std::string path = folder.path("checkpoint.h5");
    Checkpoint some;
    some.reals["pos"] = {1, 2, 3};
    some.words["phase"] = "drape";
    write_checkpoint(path, some);
    CHECK(read_checkpoint(path).reals == some.reals);
    std::string bytes;
    {
        std::ifstream file(path, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(file), {});
    }
    for (std::size_t k = 0; k < bytes.size(); k += 37) {
        INFO("byte " << k);
        std::string damaged = bytes;
        damaged[k] = char(damaged[k] ^ (1 << k % 8));
        CHECK_THROWS_AS(read_checkpoint(folder.write("damaged.h5", damaged)), InputError);
    }
    CHECK_THROWS_AS(read_checkpoint(folder.write("cut.h5", bytes.substr(0, bytes.size() / 2))), InputError);
    CHECK_THROWS_AS(read_checkpoint(folder.write("empty.h5", "")), InputError);
}

TEST_CASE("numbers that are not finite are refused by the name of their array")
{
    SavedRun saved;
    Checkpoint checkpoint = saved.checkpoint;
    checkpoint.reals["pos"][4] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(saved.load(checkpoint), contains_text("pos"));
}

TEST_CASE("indices that lead nowhere and counts that cannot be are refused by the name of their array")
{
    SavedRun saved;
    for (const int face : {50, -2, INT_MAX, INT_MIN}) {
        Checkpoint checkpoint = saved.checkpoint;
        checkpoint.integers["largest.face"] = {face};
        CHECK_THROWS_WITH(saved.load(checkpoint), contains_text("largest.face"));
    }
    for (const int count : {INT_MAX, INT_MIN}) {
        Checkpoint checkpoint = saved.checkpoint;
        checkpoint.integers["counters.steps"] = {count};
        CHECK_THROWS_WITH(saved.load(checkpoint), contains_text("counters.steps"));
    }
}

TEST_CASE("corners of pairs that lead nowhere are refused")
{
    SavedRun saved;
    SceneRunner touching{"builtin:sphere", {"sheet.resolution=6"}};
    Phase phase = touching.make_phase(true);
    const std::unique_ptr<Integrator> integrator = make_integrator("bdf2", phase);
    save_run(saved.path, some_identity(), some_progress(), phase, *integrator);
    const Checkpoint whole = read_checkpoint(saved.path);
    load_phase(whole, saved.path, phase, *integrator);
    const int particles = phase.state().size.vertex_count;
    for (const int corner : {particles, -(1 << 30), INT_MAX, INT_MIN}) {
        INFO(corner);
        Checkpoint checkpoint = whole;
        checkpoint.integers["searches.asleep.keys"] = {0, 0, 1, 2, corner};
        checkpoint.reals["searches.asleep.distance"] = {0.1};
        CHECK_THROWS_WITH(load_phase(checkpoint, saved.path, phase, *integrator), contains_text("searches"));
    }
}
