#include "host/styles/blocks/placement.hpp"
#include "host/styles/blocks/skirt_block.hpp"
#include "host/styles/style_drafts.hpp"

namespace selvage {
namespace {

constexpr double fullness = 1.8;     // width of the cloth over that of the band; Aldrich gives 1.5 to 3 by the cloth
constexpr double knee_share = 0.95;  // length over the distance from waist to knee

// Folds of a quarter of the skirt, laid before it is sewn: what is gathered at random folds at random.
constexpr int folds = 3;
constexpr double most_fold_angle = 0.9;  // [rad]

}  // namespace

Pattern draft_gathered_skirt(const StyleBody& body)
{
    const StyleMeasures& m = body.measures;
    PatternDraft garment;
    add_waistband(garment, body, m.waist, 1, 1);
    const double half = fullness * m.waist / 4, length = knee_share * m.waist_to_knee;
    const std::vector<Vec3> below = below_waist(body);
    for (const bool front : {true, false}) {
        PanelDraft skirt(front ? "front" : "back", {0, -length});
        skirt.line({half, -length}, "hem").line({half, 0}, "side").line({0, 0}, "waist");
        skirt = unfolded(skirt, front);
        const Vec3 axis(0, body.waist_y, 0), outward = front ? -Vec3::UnitY() : Vec3(Vec3::UnitY());
        hang_around(skirt.panel, below, axis, outward, body.waist_height - 0.01);
        fold_around(skirt.panel, below, axis, outward, folds, most_fold_angle);
        garment.add(skirt);
        for (const std::string side : {"left", "right"})
            garment.sew(skirt.panel.name + "." + side + "_waist", "waistband_" + skirt.panel.name + "." + side + "_0");
    }
    garment.sew("front.left_side", "back.left_side");
    garment.sew("front.right_side", "back.right_side");
    return garment.pattern();
}

}  // namespace selvage
