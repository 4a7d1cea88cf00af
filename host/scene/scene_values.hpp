#pragma once
#include <map>
#include <string>
#include <string_view>

#include "io/scene/scene.hpp"

namespace selvage {

/// All that a scene says, with defaults and presets put in: key path to value as text, from which the number can be
/// read back. A key that names a file has, as KEY.contents, a hash of what all files of that name hold.
std::map<std::string, std::string> scene_values(const Scene& scene);

/// Whether a key may change where a run is resumed: how long it goes on, how it computes without changing results, and
/// what it writes. docs/resume.md lists these keys.
bool may_change_on_resume(std::string_view key);

/// Compares two scenes but for what may change.
/// @returns `KEY is VALUE, was VALUE` for each of the first few that differ; empty if none does
std::string differing_values(const std::map<std::string, std::string>& now,
                             const std::map<std::string, std::string>& before);

}  // namespace selvage
