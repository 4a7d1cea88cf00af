#include "host/scene/scene_pins.hpp"

#include <algorithm>

#include "host/garment/pins.hpp"

namespace selvage {
namespace {

PinGroup group_of(const PinMotionScene& motion)
{
    if (motion.group != MovingPinGroup::automatic) return find_word<PinGroup>(word_of(motion.group)).value();
    return motion.vertices.empty() && motion.edges.empty() ? PinGroup::corners : PinGroup::none;
}

}  // namespace

void sew_elastics(Cloth& garment, const Scene& scene)
{
    for (std::size_t k = 0; k < scene.elastics.size(); ++k) {
        const std::string key = "garment.elastic[" + std::to_string(k) + "]";
        sew_elastic(garment, scene.elastics[k], scene.place(key + ".panel"), scene.place(key + ".edges"));
    }
}

void pin_cloth(Cloth& cloth, const Scene& scene, bool finest)
{
    const auto chosen = [&](const PinChoice& choice, const std::string& key) {
        return chosen_vertices(
            cloth, {choice.panel, choice.group, finest ? choice.list : "", choice.edges},
            {scene.place(key + ".panel"), scene.place(key + ".vertices"), scene.place(key + ".edges")});
    };
    const PinsScene& pins = scene.pins;
    if (pins.sheet != PinGroup::none || !pins.vertices.empty())
        hold_vertices(cloth, chosen({"", pins.sheet, pins.vertices, ""}, "pins"));
    for (std::size_t k = 0; k < scene.pin_holds.size(); ++k) {
        const PinHoldScene& hold = scene.pin_holds[k];
        hold_vertices(
            cloth, chosen({hold.panel, hold.group, hold.vertices, hold.edges}, "pins.hold[" + std::to_string(k) + "]"));
    }
    for (std::size_t k = 0; k < scene.pin_motions.size(); ++k) {
        const PinMotionScene& motion = scene.pin_motions[k];
        const std::string key = "pins.motion[" + std::to_string(k) + "]";
        move_vertices(cloth, chosen({motion.panel, group_of(motion), motion.vertices, motion.edges}, key), motion);
    }
}

bool pins_by_index(const Scene& scene)
{
    const auto lists = [](const auto& pins) { return !pins.vertices.empty(); };
    return lists(scene.pins) || std::any_of(scene.pin_holds.begin(), scene.pin_holds.end(), lists) ||
           std::any_of(scene.pin_motions.begin(), scene.pin_motions.end(), lists);
}

}  // namespace selvage
