#include <fstream>
#include <functional>

#include <nlohmann/json.hpp>

#include "host/parallel/launch.hpp"
#include "host/parallel/profile.hpp"
#include "host/run/run_profile.hpp"
#include "io/run/hdf5_file.hpp"
#include "io/run/hdf5_reader.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/scratch_file.hpp"

using namespace selvage;

namespace {

// Checks that every event lies within an earlier one or begins after its end.
void check_nesting(const TraceTrack& track)
{
    std::vector<std::int64_t> ends;
    std::int64_t last = 0;
    for (const TraceEvent& event : track.events) {
        REQUIRE(event.begin <= event.end);
        REQUIRE(event.begin >= last);
        last = event.begin;
        while (!ends.empty() && ends.back() <= event.begin) ends.pop_back();
        if (!ends.empty()) REQUIRE(event.end <= ends.back());
        ends.push_back(event.end);
    }
}

double work(int count)
{
    return sum_items(count, [](int item) { return std::sqrt(double(item)); });
}

// Records nested scopes with parallel loops between them, and a parallel loop whose tasks start parallel loops.
void record(int rounds)
{
    std::vector<double> sums(4096);
    for (int round = 0; round < rounds; ++round) {
        const TraceScope outer("outer", 1000, 10);
        work(20000);
        {
            const TraceScope inner("inner");
            work(5000);
            const TraceScope innermost("innermost");
        }
        for_each_item(int(sums.size()), [&](int item) { sums[item] = item % 1024 == 0 ? work(3000) : 0; });
    }
}

const TraceNode& node_named(const Trace& trace, const char* name)
{
    for (const TraceNode& node : trace.scopes())
        if (node.name == name) return node;
    throw std::invalid_argument(name);
}

}  // namespace

TEST_CASE("scopes form a tree whose times add up, and events nest on every track")
{
    Trace trace;
    {
        const TraceUse use(&trace);
        record(50);
    }
    const TraceNode &outer = node_named(trace, "outer"), &inner = node_named(trace, "inner");
    CHECK(trace.scopes().size() == 4);
    CHECK(outer.calls == 50);
    CHECK(outer.bytes == 50000);
    CHECK(outer.flops == 500);
    CHECK(outer.durations.size() == 50);
    CHECK(outer.inner_nanoseconds == inner.nanoseconds);
    CHECK(outer.nanoseconds > inner.nanoseconds);
    CHECK(trace.scopes()[std::size_t(inner.parent)].name == "outer");
    CHECK(node_named(trace, "innermost").depth == 3);

    std::int64_t scopes = 0, busy = 0;
    for (const TraceTrack& track : trace.tracks()) {
        check_nesting(track);
        for (const TraceEvent& event : track.events) scopes += !event.task;
        for (std::int64_t nanoseconds : track.busy) busy += nanoseconds;
    }
    CHECK(scopes == 150);
    CHECK(busy > 0);
}

TEST_CASE("nothing is recorded without an active trace, and a timed kernel is a scope of the active trace")
{
    CHECK(Trace::here() == nullptr);
    record(1);
    Trace trace;
    Profile profile;
    {
        const TraceUse use(&trace);
        profile.timed("kernel", 10, 80, [] { return work(10); });
    }
    CHECK(Trace::here() == nullptr);
    record(1);
    REQUIRE(trace.scopes().size() == 2);
    CHECK(trace.scopes()[1].name == "kernel");
    CHECK(trace.scopes()[1].bytes == 80);
    CHECK(profile.records().front().calls == 1);
}

TEST_CASE("a track that becomes too long drops its shortest events and stays properly nested")
{
    TraceTrack track;
    for (int i = 0; i < 300000; ++i) {
        const std::int64_t begin = 100000LL * i, length = i % 100 == 0 ? 50000 : 1500;
        track.add({begin + 10, begin + 10 + length / 2, 2, std::uint32_t(2 * i), true});
        track.add({begin, begin + length, 1, std::uint32_t(2 * i + 1), false});
    }
    CHECK(track.events.size() < 200000);
    CHECK(track.left_out + std::int64_t(track.events.size()) == 600000);
    const auto kept = std::count_if(track.events.begin(), track.events.end(),
                                    [](const TraceEvent& event) { return event.end - event.begin >= 50000; });
    CHECK(kept == 3000);
    std::sort(track.events.begin(), track.events.end(),
              [](const TraceEvent& a, const TraceEvent& b) { return a.begin < b.begin; });
    check_nesting(track);
}

TEST_CASE("the report holds the contents of the trace as a table, as JSON and in HDF5")
{
    Trace trace;
    {
        const TraceUse use(&trace);
        record(5);
    }
    const ProfileReport report = profile_report(trace, 2, 1e9);
    CHECK(report.rows[0].name == "run");
    CHECK(report.rows[0].self_s + report.rows[1].total_s == Approx(report.rows[0].total_s));
    CHECK(report.rows[1].p50_s <= report.rows[1].p95_s);
    CHECK(report.rows[1].busy_s >= report.rows[2].busy_s);
    const std::string table = profile_table(report);
    for (const char* word : {"outer", "innermost", "self s", "p95", "copies 1.00 GB/s"})
        CHECK(table.find(word) != std::string::npos);

    const ScratchFolder folder;
    write_chrome_trace(folder.path("trace.json"), report);
    std::ifstream file(folder.path("trace.json"));
    const nlohmann::json json = nlohmann::json::parse(file);
    std::size_t spans = 0, expected = 0;
    for (const nlohmann::json& event : json["traceEvents"]) spans += event["ph"] == "X";
    for (const ProfileTrack& track : report.tracks) expected += track.events.size();
    CHECK(spans == expected);
    CHECK_FALSE(json["otherData"]["flags"].get<std::string>().empty());

    {
        Hdf5File run(folder.path("run.h5"), Hdf5Access::create);
        run.make_group("/selvage");
    }
    write_profile(folder.path("run.h5"), report);
    const Hdf5Reader run(folder.path("run.h5"));
    CHECK(run.texts("/selvage/profile", "phase") ==
          std::vector<std::string>{"run", "run/outer", "run/outer/inner", "run/outer/inner/innermost"});
    CHECK(run.read_integers("/selvage/profile/calls") == std::vector<std::int64_t>{1, 5, 5, 5});
    CHECK(run.read_reals("/selvage/profile/total_s")[1] == Approx(report.rows[1].total_s));
    CHECK(run.integer("/selvage/profile", "threads") == 2);
    CHECK(run.text("/selvage/profile", "cpu_name") == report.machine.cpu_name);
}
