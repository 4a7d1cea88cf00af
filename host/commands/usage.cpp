#include <algorithm>

#include <CLI/CLI.hpp>

#include "host/commands/commands.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

std::vector<std::string> subcommand_names(const CLI::App& program)
{
    std::vector<std::string> names;
    for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
    return names;
}

std::vector<std::string> option_names(const CLI::App& command)
{
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name)
{
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string nearest_usage(const CLI::App& program, const std::vector<std::string>& arguments)
{
    const CLI::App* command = &program;
    for (const std::string& argument : arguments) {
        if (argument == "--") break;
        if (argument.starts_with("--")) {
            const std::string name = argument.substr(0, argument.find('='));
            const std::vector<std::string> known = option_names(*command);
            if (!contains(known, name)) return nearest_name(name, known);
        } else if (command == &program) {
            const std::vector<std::string> known = subcommand_names(program);
            if (!contains(known, argument)) return nearest_name(argument, known);
            command = program.get_subcommand(argument);
        }
    }
    return {};
}

}  // namespace selvage
