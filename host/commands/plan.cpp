#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "host/commands/commands.hpp"
#include "host/scene/plan_text.hpp"
#include "io/scene/read_scene.hpp"
#include "io/scene/scene.hpp"

namespace selvage {
namespace {

struct PlanArguments {
    SceneChoice scene;
    bool json = false;
};

int plan(const PlanArguments& arguments)
{
    const Scene scene = read_scene(arguments.scene.source, arguments.scene.overrides);
    std::cout << describe_plan(scene, arguments.json);
    return 0;
}

}  // namespace

void add_plan_command(CLI::App& program, Action& chosen)
{
    auto arguments = std::make_shared<PlanArguments>();
    CLI::App* command =
        program.add_subcommand("plan", "Show what would run, what is skipped and why, and the memory needed");
    add_scene_options(*command, arguments->scene);
    command->add_flag("--json", arguments->json, "print JSON");
    command->footer("Example:\n  selvage plan builtin:sphere --set sheet.resolution=257");
    command->callback([arguments, &chosen] { chosen = [arguments] { return plan(*arguments); }; });
}

}  // namespace selvage
