#include "io/scene/scene.hpp"

#include <algorithm>
#include <filesystem>

namespace selvage {

bool Scene::moves() const
{
    return !pin_motions.empty() ||
           std::any_of(bodies.begin(), bodies.end(), [](const BodyScene& body) { return body.moves(); });
}

InputPlace Scene::place(const std::string& key) const
{
    const auto known = places.find(key);
    return known == places.end() ? InputPlace{file, 0, 0, key} : known->second;
}

std::string Scene::resolve(const std::string& file_name) const
{
    return (std::filesystem::path(folder) / file_name).string();
}

}  // namespace selvage
