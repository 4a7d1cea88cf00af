#pragma once
#include <span>
#include <string>
#include <vector>

#include "io/scene/scene.hpp"

namespace selvage {

/// Reads and checks a scene.
/// @param source     path of a TOML file, or `builtin:NAME`
/// @param overrides  `table.key=value` in TOML syntax; a bare word is taken as a string; `sheet.KEY` sets every sheet
/// @throws InputError with file, line, column, key, value and expectation for the first fault.
Scene read_scene(const std::string& source, std::span<const std::string> overrides);

/// Reads and checks a scene whose text is at hand, such as that which a run keeps.
/// @param source  where the text once stood: file names in it are resolved against its folder
/// @throws InputError as read_scene
Scene read_scene_text(const std::string& text, const std::string& source);

struct SceneInfo {
    std::string name;
    std::string summary;
    std::vector<std::string> parameters;  ///< Keys that are commonly overridden.
};

/// Returns the built-in scenes, sorted by name.
std::vector<SceneInfo> builtin_scenes();

}  // namespace selvage
