#include <CLI/CLI.hpp>

#include "host/commands/commands.hpp"

namespace selvage {

void add_scene_options(CLI::App& command, SceneChoice& choice, const std::string& default_scene)
{
    choice.source = default_scene;
    auto* scene =
        command.add_option("SCENE", choice.source, "scene file (TOML), or builtin:NAME (see `selvage scenes`)");
    if (default_scene.empty())
        scene->required();
    else
        scene->capture_default_str();
    command.add_option("--set", choice.overrides, "set a key of the scene; may be repeated (see `selvage schema`)")
        ->type_name("TABLE.KEY=VALUE")
        ->allow_extra_args(false);
}

}  // namespace selvage
