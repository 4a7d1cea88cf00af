#include "bench/suites/skip.hpp"

#include <algorithm>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/harness/child_run.hpp"
#include "bench/harness/machine.hpp"
#include "bench/harness/options.hpp"
#include "bench/suites/skip_cases.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;

struct SkipOptions {
    int resolution = 65, repeats = 3;
    double until = 0.3;
    std::string feature, program = own_program();
};

struct SkipResult {
    SkipCase of;
    // The smallest values of all repeats.
    double wall_s = std::numeric_limits<double>::infinity(), cpu_s = wall_s, peak_memory_bytes = wall_s;
    double linear_iterations = 0;
    std::int64_t launches = 0;
    bool in_use = false, embree = false, opencv = false;
};

SkipOptions read_skip_options(const std::vector<std::string>& arguments)
{
    SkipOptions options;
    for (const auto& [name, value] :
         read_options("bench skip", arguments, {"--resolution", "--repeats", "--until", "--feature", "--program"},
                      "--resolution N, --repeats N, --until S, --feature NAME or --program FILE")) {
        if (name == "--resolution")
            options.resolution = read_number(name, value, 5, 2049, "vertices a side from 5 to 2049");
        if (name == "--repeats") options.repeats = read_number(name, value, 1, 100, "a number from 1 to 100");
        if (name == "--until")
            options.until = read_number(name, value, 0.01, 100.0, "simulated seconds from 0.01 to 100");
        if (name == "--feature") options.feature = value;
        if (name == "--program") options.program = value;
    }
    return options;
}

// Whether a profiled run has a phase. Phases at the end of a run, such as writing the last frame, are ignored because
// every run has them. The exception is the picture, which is only drawn at the end.
bool has_phase(const ChildRun& run, const std::string& name)
{
    return std::any_of(run.phases.begin(), run.phases.end(), [&](const std::string& path) {
        const bool at_end = path.find("conclude/") != std::string::npos && path.find("/picture/") == std::string::npos;
        return path.substr(path.rfind('/') + 1) == name && !at_end;
    });
}

void require_finished(const ChildRun& run, const SkipCase& of)
{
    if (!run.finished()) throw std::runtime_error("bench skip: " + of.feature + " " + of.state + ": " + run.errors);
}

// Runs a case with a profile, which shows what is launched and initialised. Its cost is measured without a profile, by
// time_once().
SkipResult profile_once(const SkipCase& of, const std::string& program)
{
    SkipResult result;
    result.of = of;
    const ChildRun run = run_child(program, {of.scene, "--profile"});
    require_finished(run, of);
    result.launches = run.launches;
    result.in_use = has_phase(run, of.trace);
    result.embree = has_phase(run, "embree");
    result.opencv = has_phase(run, "opencv");
    result.linear_iterations = run.summary["linear_iterations"].get<double>();
    return result;
}

void time_once(SkipResult& result, const std::string& program)
{
    const ChildRun run = run_child(program, {result.of.scene});
    require_finished(run, result.of);
    result.wall_s = std::min(result.wall_s, run.wall_s);
    result.cpu_s = std::min(result.cpu_s, run.cpu_s);
    result.peak_memory_bytes = std::min(result.peak_memory_bytes, run.peak_memory_bytes);
}

// Returns the result of the same feature when it is absent, which is the first one of the feature.
const SkipResult& absent_of(const std::vector<SkipResult>& results, const SkipResult& result)
{
    return *std::find_if(results.begin(), results.end(),
                         [&](const SkipResult& other) { return other.of.feature == result.of.feature; });
}

std::vector<SkipResult> measure(const SkipOptions& options, const std::string& folder)
{
    std::vector<SkipResult> results;
    std::vector<std::string> names;
    for (const SkipCase& of : skip_cases(options.resolution, options.until, folder)) {
        names.push_back(of.feature);
        if (options.feature.empty() || of.feature == options.feature)
            results.push_back(profile_once(of, options.program));
    }
    if (results.empty())
        throw InputError({"", 0, 0, "--feature"}, "`" + options.feature + "`", "a feature that this version has",
                         nearest_name(options.feature, names));
    for (int repeat = 0; repeat < options.repeats; ++repeat)
        for (SkipResult& result : results) {
            time_once(result, options.program);
            std::cerr << fmt::format("{} {}: {:.3f} s\n", result.of.feature, result.of.state, result.cpu_s);
        }
    return results;
}

std::string initialised(const SkipResult& r)
{
    return r.embree && r.opencv ? "embree opencv" : r.embree ? "embree" : r.opencv ? "opencv" : "-";
}

std::string table(const std::vector<SkipResult>& results)
{
    std::string text =
        fmt::format("{:<13} {:<7} {:>7} {:>9} {:>9} {:>8} {:>11} {:>8} {:>9} {:>8}  {}\n", "feature", "state", "in use",
                    "wall s", "cpu s", "of absent", "memory MiB", "of absent", "launches", "linear", "initialised");
    for (const SkipResult& r : results) {
        const SkipResult& absent = absent_of(results, r);
        text += fmt::format("{:<13} {:<7} {:>7} {:>9.3f} {:>9.3f} {:>8.1f}% {:>11.1f} {:>8.1f}% {:>9} {:>8.0f}  {}\n",
                            r.of.feature, r.of.state, r.in_use ? "yes" : "no", r.wall_s, r.cpu_s,
                            100 * r.cpu_s / absent.cpu_s, r.peak_memory_bytes / (1 << 20),
                            100 * r.peak_memory_bytes / absent.peak_memory_bytes, r.launches, r.linear_iterations,
                            initialised(r));
    }
    return text +
           "times: the least of all repeats, of the whole process; of absent: processor time and memory against the "
           "run "
           "without the feature\n";
}

Json json_report(const std::vector<SkipResult>& results)
{
    Json report;
    report["context"] = bench_context(int(std::thread::hardware_concurrency()));
    report["benchmarks"] = Json::array();
    for (const SkipResult& r : results) {
        const SkipResult& absent = absent_of(results, r);
        Json run = timed_run(r.of.feature + "/" + r.of.state, r.wall_s, r.cpu_s);
        run["peak_memory_bytes"] = r.peak_memory_bytes;
        run["time_of_absent"] = r.cpu_s / absent.cpu_s;
        run["memory_of_absent"] = r.peak_memory_bytes / absent.peak_memory_bytes;
        run["launches"] = r.launches;
        run["linear_iterations"] = r.linear_iterations;
        run["in_use"] = r.in_use;
        run["embree"] = r.embree;
        run["opencv"] = r.opencv;
        report["benchmarks"].push_back(std::move(run));
    }
    return report;
}

}  // namespace

void bench_skip(bool json, const std::vector<std::string>& arguments, std::ostream& out)
{
    const SkipOptions options = read_skip_options(arguments);
    const WorkFolder folder;
    const std::vector<SkipResult> results = measure(options, folder.path());
    out << (json ? json_report(results).dump(2) + "\n" : table(results));
}

}  // namespace selvage
