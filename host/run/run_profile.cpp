#include "host/run/run_profile.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "host/parallel/copy_bandwidth.hpp"

namespace selvage {
namespace {

// Enough to leave the caches of one core; a benchmark's larger arrays would take longer than short runs.
constexpr std::size_t most_copy_bytes = std::size_t(128) << 20;
constexpr int copy_passes = 4;

double quantile(std::vector<float> values, double part)
{
    if (values.empty()) return 0;
    const auto at = values.begin() + std::ptrdiff_t(part * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return double(*at);
}

ProfileRow row_of(const TraceNode& node)
{
    ProfileRow row;
    row.name = node.name;
    row.parent = node.parent;
    row.depth = node.depth;
    row.calls = node.calls;
    row.launches = node.launches;
    row.total_s = 1e-9 * double(node.nanoseconds);
    row.self_s = 1e-9 * double(node.nanoseconds - node.inner_nanoseconds);
    row.p50_s = quantile(node.durations, 0.5);
    row.p95_s = quantile(node.durations, 0.95);
    row.bytes = node.bytes;
    row.flops = node.flops;
    return row;
}

}  // namespace

ProfileReport profile_report(const Trace& trace, int threads, double copy_bytes_per_second)
{
    ProfileReport report;
    report.machine = describe_machine();
    report.threads = threads;
    report.copy_bytes_per_second = copy_bytes_per_second;
    for (const TraceNode& node : trace.scopes()) report.rows.push_back(row_of(node));
    ProfileRow& whole = report.rows.front();  // is never opened: it stands for all that is recorded
    whole.calls = 1;
    whole.total_s = whole.p50_s = whole.p95_s = 1e-9 * double(trace.now());
    whole.self_s += whole.total_s;
    const std::vector<TraceTrack> tracks = trace.tracks();
    for (std::size_t t = 0; t < tracks.size(); ++t) {
        ProfileTrack track;
        track.thread = t == 0 ? "main" : fmt::format("worker {}", t);
        track.left_out = tracks[t].left_out;
        track.shortest_s = 1e-9 * double(tracks[t].shortest);
        for (const TraceEvent& event : tracks[t].events)
            track.events.push_back({event.begin, event.end, event.scope, event.task});
        for (std::size_t scope = 0; scope < tracks[t].busy.size(); ++scope)
            report.rows[scope].busy_s += 1e-9 * double(tracks[t].busy[scope]);
        report.tracks.push_back(std::move(track));
    }
    // A row stands after its parent.
    for (std::size_t row = report.rows.size() - 1; row > 0; --row)
        report.rows[std::size_t(report.rows[row].parent)].busy_s += report.rows[row].busy_s;
    return report;
}

void conclude_profile(const Trace& trace, const std::string& folder)
{
    const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    const int threads = std::min(int(allowed), tbb::this_task_arena::max_concurrency());
    ProfileReport report = profile_report(trace, threads, 1);
    report.copy_bytes_per_second = measure_copy_bandwidth(most_copy_bytes, copy_passes);
    fmt::print(stderr, "{}", profile_table(report));
    write_chrome_trace(folder + "/trace.json", report);
    if (std::filesystem::exists(folder + "/run.h5")) write_profile(folder + "/run.h5", report);
}

}  // namespace selvage
