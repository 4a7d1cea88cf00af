#include <csignal>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "bench/bench_command.hpp"
#include "host/commands/commands.hpp"
#include "host/commands/standard_streams.hpp"
#include "host/parallel/subnormals.hpp"
#include "io/errors.hpp"
#include "io/version.hpp"
#include "validation/validate_command.hpp"

namespace {

using namespace selvage;

// Part of the contract with scripts; a run itself may also return 4 (limits reached) and 128 + a signal (interrupted).
constexpr int internal_error = 1, bad_input = 2, diverged = 3;

void add_commands(CLI::App& program, Action& chosen)
{
    AddCommand* const commands[] = {add_drape_command,   add_plan_command,    add_check_command,  add_render_command,
                                    add_info_command,    add_measure_command, add_styles_command, add_scenes_command,
                                    add_fabrics_command, add_schema_command,  add_bench_command,  add_validate_command};
    for (AddCommand* add : commands) add(program, chosen);
    program.set_version_flag("--version", std::string("selvage ") + version, "Print the version and exit");
    program.footer("Example:\n  selvage drape builtin:tshirt -o out\n`selvage COMMAND --help` tells more.");
}

int refuse(const CLI::App& program, const CLI::ParseError& error, int argc, char** argv)
{
    const std::string nearest = nearest_usage(program, std::vector<std::string>(argv + 1, argv + argc));
    std::cerr << "selvage: " << error.what();
    if (!nearest.empty()) std::cerr << " (did you mean `" << nearest << "`?)";
    std::cerr << "\nRun with --help for more.\n";
    return bad_input;
}

int run(const Action& action)
{
    try {
        return action();
    } catch (const InputError& error) {
        std::cerr << "selvage: " << error.what() << '\n';
        return bad_input;
    } catch (const DivergenceError& error) {
        std::cerr << "selvage: " << error.what() << '\n';
        return diverged;
    } catch (const std::exception& error) {
        std::cerr << "selvage: internal error: " << error.what() << '\n';
        return internal_error;
    }
}

int run_program(int argc, char** argv)
{
    CLI::App program("Selvage drapes cloth: sews flat panels onto a body and finds how they hang.", "selvage");
    Action chosen;
    add_commands(program, chosen);
    if (argc < 2) {
        std::cerr << program.help();
        return bad_input;
    }
    try {
        program.parse(argc, argv);
    } catch (const CLI::Success& help_or_version) {
        return program.exit(help_or_version);
    } catch (const CLI::ParseError& error) {
        return refuse(program, error, argc, argv);
    }
    return chosen ? run(chosen) : run([&program] {
        std::cerr << program.help();
        return bad_input;
    });
}

}  // namespace

int main(int argc, char** argv)
{
    hold_standard_descriptors();
    std::signal(SIGXFSZ, SIG_IGN);  // a file at the limit of its size is an error of the write
    flush_subnormals();
    return with_results_printed(run_program(argc, argv));
}
