#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace selvage {

/// Begins the names of scenes and patterns that are built into the program.
inline constexpr std::string_view builtin_prefix = "builtin:";

/// Returns whether a name is one of those.
inline bool is_builtin(std::string_view name) { return name.starts_with(builtin_prefix); }

/// A file of io/presets that is built into the program by io/embed_presets.cmake.
struct PresetFile {
    std::string_view path;  ///< Below io/presets, such as `fabrics/cotton.toml`.
    std::string_view text;
};

/// Returns all built-in files, sorted by path.
std::span<const PresetFile> preset_files();

/// Returns the stems of the built-in files of one folder, such as `cotton` of `fabrics`, sorted.
std::vector<std::string> preset_names(std::string_view folder);

/// Returns the built-in file FOLDER/NAME.toml, or nullptr.
const PresetFile* find_preset(std::string_view folder, std::string_view name);

}  // namespace selvage
