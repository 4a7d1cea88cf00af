#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "host/commands/commands.hpp"
#include "host/scene/diagnose.hpp"
#include "io/scene/read_scene.hpp"
#include "io/scene/scene.hpp"

namespace selvage {
namespace {

struct CheckArguments {
    SceneChoice scene;
    std::string picture;
    bool json = false;
};

int check(const CheckArguments& arguments)
{
    const Scene scene = read_scene(arguments.scene.source, arguments.scene.overrides);
    const Diagnosis diagnosis = diagnose_scene(scene, arguments.picture);
    std::cout << (arguments.json ? diagnosis.json : diagnosis.text);
    return diagnosis.clean ? 0 : 2;
}

}  // namespace

void add_check_command(CLI::App& program, Action& chosen)
{
    auto arguments = std::make_shared<CheckArguments>();
    CLI::App* command = program.add_subcommand(
        "check", "Look for faults of a scene before it runs: intersections, penetrations, bad triangles, odd units");
    add_scene_options(*command, arguments->scene);
    command->add_option("--picture", arguments->picture, "also draw the scene as it starts")->type_name("PNG");
    command->add_flag("--json", arguments->json, "print JSON");
    command->footer(
        "Example:\n"
        "  selvage check shirt.toml --picture start.png\n"
        "Exit codes: 0 clean, 2 something was found.");
    command->callback([arguments, &chosen] { chosen = [arguments] { return check(*arguments); }; });
}

}  // namespace selvage
