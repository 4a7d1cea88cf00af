#include "bench/suites/kernels.hpp"

#include <algorithm>
#include <regex>

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "bench/harness/options.hpp"
#include "bench/harness/report.hpp"
#include "bench/suites/kernel_cases.hpp"
#include "host/parallel/copy_bandwidth.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

std::regex read_filter(const std::string& text)
{
    try {
        return std::regex(text);
    } catch (const std::regex_error&) {
        throw InputError({"", 0, 0, "--filter"}, "`" + text + "`", "a regular expression (ECMAScript)");
    }
}

void set_option(KernelOptions& options, const std::string& name, const std::string& value)
{
    if (name == "--vertices")
        options.vertices = read_number(name, value, 16, 16'000'000, "a number of vertices from 16 to 16000000");
    else if (name == "--threads")
        options.threads = read_number(name, value, 0, 1024, "a number of threads from 0 (all cores) to 1024");
    else if (name == "--min-time")
        options.min_time = read_number(name, value, 1e-6, 3600.0, "seconds from 1e-6 to 3600");
    else
        options.filter = value;
}

void measure(benchmark::State& timer, const KernelCase& kernel, double copy_bandwidth)
{
    if (kernel.prepare) kernel.prepare();
    for (auto _ : timer) {
        if (kernel.reset) {
            timer.PauseTiming();
            kernel.reset();
            timer.ResumeTiming();
        }
        kernel.run();
    }
    using benchmark::Counter;
    const double items = kernel.items, bytes = double(kernel.bytes);
    timer.SetLabel(kernel.item);
    timer.SetItemsProcessed(timer.iterations() * std::int64_t(kernel.items));
    timer.SetBytesProcessed(timer.iterations() * std::int64_t(kernel.bytes));
    timer.counters["items"] = items;
    timer.counters["bytes_per_item"] = bytes / items;
    timer.counters["ns_per_item"] = Counter(1e-9 * items, Counter::kIsIterationInvariantRate | Counter::kInvert);
    timer.counters["copy_fraction"] = Counter(bytes / copy_bandwidth, Counter::kIsIterationInvariantRate);
}

void register_cases(const std::vector<KernelCase>& cases, const KernelOptions& options, double copy_bandwidth)
{
    benchmark::ClearRegisteredBenchmarks();
    for (const KernelCase& kernel : cases)
        benchmark::RegisterBenchmark(
            kernel.name.c_str(),
            [&kernel, copy_bandwidth](benchmark::State& timer) { measure(timer, kernel, copy_bandwidth); })
            ->MinTime(options.min_time)
            ->UseRealTime();
}

void keep_matching(const std::string& filter, std::vector<KernelCase>& cases)
{
    std::vector<std::string> names;
    for (const KernelCase& kernel : cases) names.push_back(kernel.name);
    const std::regex pattern = read_filter(filter);
    std::erase_if(cases, [&](const KernelCase& kernel) { return !std::regex_search(kernel.name, pattern); });
    if (cases.empty())
        throw InputError({"", 0, 0, "--filter"}, "`" + filter + "`, which matches no kernel",
                         "part of a name such as membrane/force", nearest_name(filter, names));
}

}  // namespace

KernelOptions read_kernel_options(const std::vector<std::string>& options)
{
    const std::vector<std::string> names = {"--vertices", "--threads", "--min-time", "--filter"};
    KernelOptions result;
    for (const auto& [name, value] :
         read_options("bench kernels", options, names, "--vertices N, --threads N, --min-time S or --filter REGEX"))
        set_option(result, name, value);
    read_filter(result.filter);
    return result;
}

void bench_kernels(bool json, const std::vector<std::string>& arguments, std::ostream& out)
{
    const KernelOptions options = read_kernel_options(arguments);
    const int threads = options.threads > 0 ? options.threads : tbb::this_task_arena::max_concurrency();
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    // A separate task arena can have more threads than the machine has cores.
    tbb::task_arena(threads).execute([&] {
        KernelCloth cloth(options.vertices);
        std::vector<KernelCase> cases = kernel_cases(cloth);
        keep_matching(options.filter, cases);
        const double copy_bandwidth = measure_copy_bandwidth();
        register_cases(cases, options, copy_bandwidth);
        const mesh_sizes& size = cloth.state.size;
        run_and_report({threads,
                        copy_bandwidth,
                        {{"vertices", size.vertex_count},
                         {"faces", size.face_count},
                         {"hinges", size.hinge_count},
                         {"stitches", size.stitch_count}}},
                       json, out);
        benchmark::ClearRegisteredBenchmarks();
    });
}

}  // namespace selvage
