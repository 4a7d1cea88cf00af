#include "host/styles/blocks/bodice_block.hpp"
#include "host/styles/blocks/collar_block.hpp"
#include "host/styles/blocks/placement.hpp"
#include "host/styles/style_drafts.hpp"

namespace selvage {
namespace {

constexpr double cuff_height = 0.055, cuff_ease = 0.07;       // [m]
constexpr double sleeve_fullness = 1.12;                      // of the sleeve's hem over the cuff
constexpr double collar_width = 0.055, collar_point = 0.015;  // [m]

}  // namespace

Pattern draft_shirt(const StyleBody& body)
{
    const StyleMeasures& m = body.measures;
    BodiceStyle style;
    style.bust_ease = 0.18;
    style.length = m.neck_to_waist + m.body_rise + 0.02;
    style.flare = 1.02;
    style.waist_shaping = 0.012;
    style.neck_ease = 0.008;
    style.front_neck_depth = 0.5 * m.neck_width + 0.010;
    style.back_neck_depth = 0.015;
    style.shoulder_extension = 0.020;
    style.armscye_drop = 0.065;
    PatternDraft garment;
    PanelDraft back = unfolded(draft_half_bodice(false, style, body), false);
    place_bodice(back.panel, false, body);
    PanelDraft left = draft_half_bodice(true, style, body).close("centre");
    left.panel.name = "left_front";
    PanelDraft right = mirrored(left, "right_front");
    // Both fronts start as one piece, buttoned.
    PanelDraft whole = unfolded(draft_half_bodice(true, style, body), true);
    place_bodice(whole.panel, true, body);
    for (PanelDraft* half : {&left, &right}) {
        place_like(half->panel, whole.panel);
        garment.add(*half);
    }
    garment.add(back);
    garment.sew("left_front.centre", "right_front.centre");
    for (const std::string side : {"left", "right"})
        for (const std::string edge : {"shoulder", "side"})
            garment.sew(side + "_front." + edge, "back." + side + "_" + edge);
    const double cuff = m.wrist + cuff_ease;
    const Armholes armholes{.front = {"left_front.armhole", "right_front.armhole"}};
    const double under = m.arm_length - cuff_height - 0.09;
    const double hem =
        add_sleeves(garment, {.ease = 0.12, .length = under, .cuff = sleeve_fullness * cuff}, body, armholes);
    add_cuffs(garment, body, cuff, cuff_height, hem + StartGaps::panels);
    add_flat_collar(garment, draft_half_bodice(true, style, body), draft_half_bodice(false, style, body), whole.panel,
                    back.panel, collar_width, collar_point);
    return garment.pattern();
}

}  // namespace selvage
