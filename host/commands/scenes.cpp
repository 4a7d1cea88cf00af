#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "host/commands/commands.hpp"
#include "io/scene/read_scene.hpp"
#include "io/scene/scene.hpp"

namespace selvage {
namespace {

void print_json(const std::vector<SceneInfo>& scenes)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const SceneInfo& scene : scenes)
        list.push_back({{"name", scene.name}, {"summary", scene.summary}, {"parameters", scene.parameters}});
    std::cout << list.dump(2) << '\n';
}

void print_text(const std::vector<SceneInfo>& scenes)
{
    for (const SceneInfo& scene : scenes) {
        std::cout << "builtin:" << scene.name << "\n    " << scene.summary << '\n';
        for (const std::string& parameter : scene.parameters) std::cout << "    --set " << parameter << "=...\n";
    }
}

}  // namespace

void add_scenes_command(CLI::App& program, Action& chosen)
{
    auto json = std::make_shared<bool>(false);
    CLI::App* command = program.add_subcommand("scenes", "List the built-in scenes and the keys worth setting");
    command->add_flag("--json", *json, "print JSON");
    command->footer("Example:\n  selvage scenes --json");
    command->callback([json, &chosen] {
        chosen = [json] {
            *json ? print_json(builtin_scenes()) : print_text(builtin_scenes());
            return 0;
        };
    });
}

}  // namespace selvage
