#include "bench/bench_command.hpp"

#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>

#include "bench/bench.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

struct BenchArguments {
    std::string suite;
    std::vector<std::string> options;
    bool json = false;
};

int bench(const BenchArguments& arguments)
{
    const std::vector<std::string> suites = bench_suites();
    if (std::find(suites.begin(), suites.end(), arguments.suite) == suites.end())
        throw InputError({"", 0, 0, "SUITE"}, "`" + arguments.suite + "`", "one of " + CLI::detail::join(suites, ", "),
                         nearest_name(arguments.suite, suites));
    return run_bench(arguments.suite, arguments.json, arguments.options);
}

}  // namespace

void add_bench_command(CLI::App& program, Action& chosen)
{
    auto arguments = std::make_shared<BenchArguments>();
    CLI::App* command = program.add_subcommand("bench", "Measure speed; prints Google Benchmark's format");
    command->add_option("SUITE", arguments->suite, "one of " + CLI::detail::join(bench_suites(), ", "))->required();
    command->add_option("OPTIONS", arguments->options, "options of the suite, after `--`");
    command->add_flag("--json", arguments->json, "print JSON");
    command->footer("Example:\n  selvage bench kernels --json");
    command->callback([arguments, &chosen] { chosen = [arguments] { return bench(*arguments); }; });
}

}  // namespace selvage
