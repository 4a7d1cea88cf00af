#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "host/commands/commands.hpp"
#include "io/scene/scene.hpp"
#include "io/scene/scene_schema.hpp"

namespace selvage {

void add_schema_command(CLI::App& program, Action& chosen)
{
    auto json = std::make_shared<bool>(false);
    CLI::App* command =
        program.add_subcommand("schema", "Document every key of a scene file: default, unit, range, meaning");
    command->add_flag("--json", *json, "print JSON");
    command->footer("Example:\n  selvage schema | grep solver");
    command->callback([json, &chosen] {
        chosen = [json] {
            std::cout << (*json ? scene_schema_json() : scene_schema_text());
            return 0;
        };
    });
}

}  // namespace selvage
