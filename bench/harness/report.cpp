#include "bench/harness/report.hpp"

#include <algorithm>
#include <iostream>
#include <sstream>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/harness/machine.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;

void extend_context(const BenchContext& context, Json& to)
{
    describe_machine(to);
    to["threads"] = context.threads;
    to["copy_bytes_per_second"] = context.copy_bandwidth;
    for (const auto& [name, size] : context.sizes) to[name] = size;
}

// Google Benchmark appends its settings to each name. They are removed because they do not tell what was measured.
void shorten_names(Json& benchmarks)
{
    for (Json& run : benchmarks)
        for (const char* key : {"name", "run_name"}) {
            const std::string name = run[key];
            run[key] = name.substr(0, name.find("/min_time:"));
        }
}

Json run_registered()
{
    std::ostringstream text;
    benchmark::JSONReporter reporter;
    reporter.SetOutputStream(&text);
    reporter.SetErrorStream(&std::cerr);
    benchmark::RunSpecifiedBenchmarks(&reporter, ".");
    return Json::parse(text.str());
}

std::string machine_lines(const Json& context, const BenchContext& bench)
{
    std::string sizes;
    for (const auto& [name, size] : bench.sizes) sizes += fmt::format("{}{} {}", sizes.empty() ? "" : ", ", size, name);
    return fmt::format("selvage {}, {}, {}, {}\n{}, {} cores, {} threads, copies {:.2f} GB/s\n{}\n\n",
                       context["version"].get<std::string>(), context["compiler"].get<std::string>(),
                       context["build_type"].get<std::string>(), context["instruction_set"].get<std::string>(),
                       context["cpu_name"].get<std::string>(), context["num_cpus"].get<int>(), bench.threads,
                       1e-9 * bench.copy_bandwidth, sizes);
}

std::string table(const Json& benchmarks)
{
    std::size_t width = 6;
    for (const Json& run : benchmarks) width = std::max(width, run["name"].get<std::string>().size());
    std::string text = fmt::format("{:<{}} {:>10} {:<8} {:>10} {:>12} {:>10} {:>9}\n", "kernel", width, "items", "",
                                   "ns/item", "bytes/item", "GB/s", "of copy");
    for (const Json& run : benchmarks)
        text += fmt::format("{:<{}} {:>10.0f} {:<8} {:>10.3f} {:>12.1f} {:>10.2f} {:>8.1f}%\n",
                            run["name"].get<std::string>(), width, run["items"].get<double>(),
                            run["label"].get<std::string>(), run["ns_per_item"].get<double>(),
                            run["bytes_per_item"].get<double>(), 1e-9 * run["bytes_per_second"].get<double>(),
                            100 * run["copy_fraction"].get<double>());
    return text + "\nAbove 100 % of the copy speed the arrays stay in the caches from call to call.\n";
}

}  // namespace

void run_and_report(const BenchContext& context, bool json, std::ostream& out)
{
    Json result = run_registered();
    extend_context(context, result["context"]);
    shorten_names(result["benchmarks"]);
    if (json)
        out << result.dump(2) << '\n';
    else
        out << machine_lines(result["context"], context) << table(result["benchmarks"]);
}

}  // namespace selvage
