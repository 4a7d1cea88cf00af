#include <CLI/CLI.hpp>

#include "host/commands/commands.hpp"

namespace selvage {
namespace {

// An option that takes a word of a choice.
template <class Choice>
void add_word_option(CLI::App& command, const std::string& name, Choice& target, const std::string& meaning)
{
    const auto words = words_of<Choice>();
    command
        .add_option_function<std::string>(
            name, [&target](const std::string& word) { target = *find_word<Choice>(word); }, meaning)
        ->check(CLI::IsMember(std::vector<std::string>(words.begin(), words.end())))
        ->default_str(std::string(word_of(target)));
}

}  // namespace

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

void add_body_options(CLI::App& command, BodySource& body)
{
    add_word_option(command, "--unit", body.unit, "length unit of the OBJ file");
    add_word_option(command, "--up", body.up_axis, "up direction of the OBJ file");
    command.add_option("--scale", body.scale, "scales the OBJ file")
        ->check(CLI::Range(1e-4, 1e4))
        ->capture_default_str();
    command.add_option("--set", body.overrides, "set a key of the scene; may be repeated")
        ->type_name("TABLE.KEY=VALUE")
        ->allow_extra_args(false);
}

}  // namespace selvage
