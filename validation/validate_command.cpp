#include "validation/validate_command.hpp"

#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "validation/cases/cases.hpp"

namespace selvage {
namespace {

struct ValidateArguments {
    std::vector<std::string> names;
    bool json = false, list = false, quick = false;
};

int validate(const ValidateArguments& arguments)
{
    if (arguments.list) {
        for (const CaseGroup& group : case_groups()) std::cout << group.name << "  " << group.summary << '\n';
        return 0;
    }
    const std::vector<ValidationRow> rows =
        run_cases(arguments.names, arguments.quick, [](const std::string& line) { std::cerr << line << std::endl; });
    std::cout << (arguments.json ? validation_json(rows) + "\n" : validation_table(rows));
    return std::all_of(rows.begin(), rows.end(), [](const ValidationRow& row) { return row.pass; }) ? 0 : 1;
}

}  // namespace

void add_validate_command(CLI::App& program, Action& chosen)
{
    auto arguments = std::make_shared<ValidateArguments>();
    CLI::App* command = program.add_subcommand("validate", "Compare the solver with closed forms and measurements");
    command->add_option("CASE", arguments->names, "groups of cases to run, as --list prints them; without one: all");
    command->add_flag("--json", arguments->json, "print JSON");
    command->add_flag("--list", arguments->list, "print the groups and end");
    command->add_flag("--quick", arguments->quick, "leave out the cases that take long");
    command->footer(
        "The exit code is 0 if every case with a verdict passes, otherwise 1.\n"
        "Rows without a tolerance are information.\n"
        "Example:\n  selvage validate cantilever catenary --json");
    command->callback([arguments, &chosen] { chosen = [arguments] { return validate(*arguments); }; });
}

}  // namespace selvage
