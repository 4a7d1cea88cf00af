#pragma once
#include <string>
#include <vector>

#include "host/commands/command.hpp"
#include "host/scene/measured_body.hpp"

namespace selvage {

AddCommand add_drape_command, add_plan_command, add_check_command, add_render_command, add_info_command,
    add_measure_command, add_styles_command, add_scenes_command, add_fabrics_command, add_schema_command;

/// The scene that a subcommand works on.
struct SceneChoice {
    std::string source;                  ///< Path of a TOML file, or `builtin:NAME`.
    std::vector<std::string> overrides;  ///< `table.key=value`, each.
};

/// Adds the positional SCENE and the option --set, which fill `choice`.
/// @param default_scene  used if SCENE is not given; empty: SCENE is required
void add_scene_options(CLI::App& command, SceneChoice& choice, const std::string& default_scene = {});

/// Adds the options --unit, --up and --scale of an OBJ file and --set of a scene, which fill `body`, as long as it
/// lives.
void add_body_options(CLI::App& command, BodySource& body);

/// Returns the valid subcommand or option closest to the first one on the command line that `program` does not know,
/// or "" if none is close.
std::string nearest_usage(const CLI::App& program, const std::vector<std::string>& arguments);

}  // namespace selvage
