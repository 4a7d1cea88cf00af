#include "host/styles/blocks/placement.hpp"
#include "host/styles/blocks/skirt_block.hpp"
#include "host/styles/style_drafts.hpp"

namespace selvage {
namespace {

constexpr double fullness = 1.8;     // width of the cloth over that of the band; Aldrich gives 1.5 to 3 by the cloth
constexpr double knee_share = 0.95;  // length over the distance from waist to knee

}  // namespace

Pattern draft_gathered_skirt(const StyleBody& body)
{
    const StyleMeasures& m = body.measures;
    PatternDraft garment;
    add_waistband(garment, body, m.waist);
    std::vector<Vec3> below = body.trunk;
    for (const std::vector<Vec3>& leg : body.leg) below.insert(below.end(), leg.begin(), leg.end());
    const double half = fullness * m.waist / 4, length = knee_share * m.waist_to_knee;
    for (const bool front : {true, false}) {
        const std::string plus = front ? "left" : "right", minus = front ? "right" : "left";
        PanelDraft skirt(front ? "front" : "back", Vec2(-half, -length));
        skirt.line({half, -length}, "hem").line({half, 0}, plus).line({0, 0}, "waist_" + plus);
        skirt.line({-half, 0}, "waist_" + minus).close(minus);
        hang_around(skirt.panel, below, {0, body.waist_y, 0}, front ? -Vec3::UnitY() : Vec3(Vec3::UnitY()),
                    body.waist_height - 0.01);
        garment.add(skirt);
        for (const std::string& side : {plus, minus})
            garment.sew(skirt.panel.name + ".waist_" + side, "waistband_" + skirt.panel.name + ".bottom_" + side);
    }
    garment.sew("front.left", "back.left");
    garment.sew("front.right", "back.right");
    return garment.pattern();
}

}  // namespace selvage
