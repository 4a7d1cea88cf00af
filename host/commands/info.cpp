#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "host/commands/commands.hpp"
#include "host/scene/describe_file.hpp"

namespace selvage {
namespace {

struct InfoArguments {
    std::string file;
    bool json = false;
};

int info(const InfoArguments& arguments)
{
    std::cout << describe_file(arguments.file, arguments.json);
    return 0;
}

}  // namespace

void add_info_command(CLI::App& program, Action& chosen)
{
    auto arguments = std::make_shared<InfoArguments>();
    CLI::App* command =
        program.add_subcommand("info", "Tell what a file holds: a run, a pattern, a mesh, a scene, fabrics");
    command
        ->add_option("FILE", arguments->file, "file to look into; also builtin:NAME, or the name of a built-in fabric")
        ->required();
    command->add_flag("--json", arguments->json, "print JSON");
    command->footer("Example:\n  selvage info out/run.h5\n  selvage info body.obj");
    command->callback([arguments, &chosen] { chosen = [arguments] { return info(*arguments); }; });
}

}  // namespace selvage
