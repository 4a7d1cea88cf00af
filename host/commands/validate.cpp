#include <memory>

#include <CLI/CLI.hpp>

#include "host/commands/commands.hpp"
#include "validation/cases/validate.hpp"

namespace selvage {
namespace {

struct ValidateArguments {
    std::vector<std::string> cases;
    bool json = false;
};

}  // namespace

void add_validate_command(CLI::App& program, Action& chosen)
{
    auto arguments = std::make_shared<ValidateArguments>();
    CLI::App* command =
        program.add_subcommand("validate", "Compare the physics with measured and analytical references");
    command->add_option("CASE", arguments->cases, "cases to run; without any: all of them");
    command->add_flag("--json", arguments->json, "print JSON");
    command->footer("Example:\n  selvage validate cantilever --json");
    command->callback(
        [arguments, &chosen] { chosen = [arguments] { return run_validation(arguments->cases, arguments->json); }; });
}

}  // namespace selvage
