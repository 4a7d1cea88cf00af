#include "io/scene/presets.hpp"

#include <algorithm>

namespace selvage {
namespace {

constexpr std::string_view extension = ".toml";

}  // namespace

std::vector<std::string> preset_names(std::string_view folder)
{
    std::vector<std::string> names;
    for (const PresetFile& file : preset_files()) {
        if (file.path.substr(0, folder.size()) != folder || file.path[folder.size()] != '/') continue;
        const std::string_view name = file.path.substr(folder.size() + 1);
        names.emplace_back(name.substr(0, name.size() - extension.size()));
    }
    std::sort(names.begin(), names.end());
    return names;
}

const PresetFile* find_preset(std::string_view folder, std::string_view name)
{
    const std::string path = std::string(folder) + "/" + std::string(name) + std::string(extension);
    for (const PresetFile& file : preset_files())
        if (file.path == path) return &file;
    return nullptr;
}

}  // namespace selvage
