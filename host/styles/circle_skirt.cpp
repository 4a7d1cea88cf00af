#include <numbers>

#include "host/styles/blocks/placement.hpp"
#include "host/styles/blocks/skirt_block.hpp"
#include "host/styles/style_drafts.hpp"

namespace selvage {
namespace {

constexpr double knee_share = 0.85;  // length over the distance from waist to knee

}  // namespace

Pattern draft_circle_skirt(const StyleBody& body)
{
    const StyleMeasures& m = body.measures;
    PatternDraft garment;
    add_waistband(garment, body, m.waist, 1, 1);
    // Aldrich, circular skirts: the waist is a whole circle.
    const double waist = m.waist / (2 * std::numbers::pi), hem = waist + knee_share * m.waist_to_knee;
    // Two halves with seams in the middle of front and back: their straight edges start level, and beside the body the
    // arms would be in the way of a seam.
    for (const bool left : {true, false}) {
        const std::string plus = left ? "back" : "front", minus = left ? "front" : "back";
        PanelDraft half(left ? "left" : "right", Vec2(-hem, 0));
        half.arc(hem, true, {0, -hem}, minus + "_hem").arc(hem, true, {hem, 0}, plus + "_hem");
        half.line({waist, 0}, plus).arc(waist, false, {0, -waist}, plus + "_waist");
        half.arc(waist, false, {-waist, 0}, minus + "_waist").close(minus);
        hang_flat(half.panel, below_waist(body), {0, body.waist_y, 0}, left ? Vec3(Vec3::UnitX()) : -Vec3::UnitX(),
                  body.waist_height);
        garment.add(half);
        for (const std::string& end : {plus, minus})
            garment.sew(half.panel.name + "." + end + "_waist", "waistband_" + end + "." + half.panel.name + "_0");
    }
    garment.sew("left.front", "right.front");
    garment.sew("left.back", "right.back");
    return garment.pattern();
}

}  // namespace selvage
