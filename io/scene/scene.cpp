#include "io/scene/scene.hpp"

#include <algorithm>
#include <filesystem>

#include "io/number_text.hpp"

namespace selvage {

bool Scene::wind_blows() const { return !wind.velocity.isZero() || wind.gust > 0; }

bool Scene::moves() const
{
    return !pin_motions.empty() ||
           std::any_of(bodies.begin(), bodies.end(), [](const BodyScene& body) { return body.moves(); });
}

Until Scene::until() const
{
    constexpr double limit = 1e6;
    const std::string equilibrium = "equilibrium";
    Until result;
    result.equilibrium = solver.until == equilibrium;
    const bool is_number = parse_number(solver.until, result.time);
    if (result.equilibrium || (is_number && result.time > 0 && result.time <= limit)) return result;
    const std::vector<std::string> words{equilibrium};
    throw InputError(place("solver.until"), "`" + solver.until + "`",
                     "\"equilibrium\" or a time above 0 and up to " + number_text(limit) + " s",
                     nearest_name(solver.until, words));
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
