#include "io/scene/pin_checks.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "io/number_text.hpp"

namespace selvage {
namespace {

void check_list(const Scene& scene, const std::string& key, std::string_view list)
{
    listed_indices(list, scene.place(key));
}

// Pins that name no panel mean the sheets, and indices one sheet.
// @param how  vertices of one panel are held
void check_whose(const Scene& scene, const std::string& key, bool by_index, const std::string& how)
{
    const std::size_t sheets = scene.sheets.size();
    if (sheets == 0)
        throw InputError(scene.place(key), "a scene without [[sheet]]",
                         "a sheet whose vertices can be held; those of a garment are by " + how);
    if (by_index && sheets > 1)
        throw InputError(scene.place(key), "indices in a scene of " + std::to_string(sheets) + " sheets",
                         how + ", as \"sheet[0]\", since each sheet counts its own vertices");
}

void check_motion(const Scene& scene, int index)
{
    const PinMotionScene& motion = scene.pin_motions[std::size_t(index)];
    const std::string path = "pins.motion[" + std::to_string(index) + "].";
    if (!(motion.end > motion.start))
        throw InputError(scene.place(path + "end"), number_text(motion.end) + " s",
                         "a time above `start`, " + number_text(motion.start) + " s");
    if (motion.turns != 0 && motion.axis.norm() == 0)
        throw InputError(scene.place(path + "axis"), "[0, 0, 0]", "a direction, as the group turns");
    check_list(scene, path + "vertices", motion.vertices);
    check_list(scene, path + "edges", motion.edges);
    if (!motion.edges.empty() && motion.panel.empty())
        throw InputError(scene.place(path + "edges"), "no `panel`", "the panel of a garment whose edges are meant");
    if (motion.panel.empty())
        check_whose(scene, path + (motion.vertices.empty() ? "group" : "vertices"), !motion.vertices.empty(),
                    "the name of the panel as `panel`");
}

void check_hold(const Scene& scene, int index)
{
    const PinHoldScene& hold = scene.pin_holds[std::size_t(index)];
    const std::string path = "pins.hold[" + std::to_string(index) + "]";
    if (hold.panel.empty())
        throw InputError(scene.place(path), "no `panel`", "the name of a sheet or panel, as \"sheet[0]\"");
    if (hold.group == PinGroup::none && hold.vertices.empty() && hold.edges.empty())
        throw InputError(scene.place(path), "neither `group` nor `edges` nor `vertices`",
                         "what of `" + hold.panel + "` is held");
    check_list(scene, path + ".edges", hold.edges);
    check_list(scene, path + ".vertices", hold.vertices);
}

}  // namespace

std::vector<int> listed_indices(std::string_view list, const InputPlace& place)
{
    std::vector<int> indices;
    while (!list.empty()) {
        const std::size_t comma = std::min(list.find(','), list.size());
        std::string_view item = list.substr(0, comma);
        while (!item.empty() && item.front() == ' ') item.remove_prefix(1);
        while (!item.empty() && item.back() == ' ') item.remove_suffix(1);
        double index = -1;
        if (!parse_number(item, index) || index < 0 || index > 2147483647.0 || index != std::floor(index))
            throw InputError(place, "`" + std::string(item) + "`", "indices from 0, separated by commas");
        indices.push_back(int(index));
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return indices;
}

void check_elastics(const Scene& scene)
{
    for (std::size_t k = 0; k < scene.elastics.size(); ++k) {
        const ElasticScene& elastic = scene.elastics[k];
        const std::string path = "garment.elastic[" + std::to_string(k) + "]";
        for (const auto& [key, value] : {std::pair{"panel", &elastic.panel}, std::pair{"edges", &elastic.edges}})
            if (value->empty())
                throw InputError(scene.place(path), std::string("no `") + key + "`",
                                 "the panel and edges it is sewn to");
        check_list(scene, path + ".edges", elastic.edges);
    }
}

void check_pins(const Scene& scene)
{
    check_list(scene, "pins.vertices", scene.pins.vertices);
    const std::string how = "[[pins.hold]] with the name of the panel as `panel`";
    if (scene.pins.sheet != PinGroup::none) check_whose(scene, "pins.sheet", false, how);
    if (!scene.pins.vertices.empty()) check_whose(scene, "pins.vertices", true, how);
    for (int hold = 0; hold < int(scene.pin_holds.size()); ++hold) check_hold(scene, hold);
    for (int motion = 0; motion < int(scene.pin_motions.size()); ++motion) check_motion(scene, motion);
}

}  // namespace selvage
