#include "host/styles/blocks/bodice_block.hpp"
#include "host/styles/blocks/collar_block.hpp"
#include "host/styles/blocks/placement.hpp"
#include "host/styles/style_drafts.hpp"

namespace selvage {
namespace {

constexpr double cuff_height = 0.06, cuff_ease = 0.06;  // [m]
constexpr double sleeve_fullness = 1.15;                // of the sleeve's hem over the cuff

}  // namespace

Pattern draft_hoody(const StyleBody& body)
{
    const StyleMeasures& m = body.measures;
    BodiceStyle style;
    style.bust_ease = 0.22;
    style.length = m.neck_to_waist + m.body_rise;
    style.flare = 0.98;
    style.waist_shaping = 0;
    style.neck_ease = 0.020;
    style.front_neck_depth = 0.5 * m.neck_width + 0.020;
    style.back_neck_depth = 0.020;
    style.shoulder_extension = 0.035;
    style.armscye_drop = 0.075;
    PatternDraft garment;
    add_bodice(garment, style, body);
    const double cuff = m.wrist + cuff_ease, under = m.arm_length - cuff_height - 0.09;
    const double hem = add_sleeves(garment, {.ease = 0.14, .length = under, .cuff = sleeve_fullness * cuff}, body);
    add_cuffs(garment, body, cuff, cuff_height, hem + StartGaps::panels);
    add_hood(garment, body, {"front.left_neck", "front.right_neck"}, {"back.left_neck", "back.right_neck"});
    return garment.pattern();
}

}  // namespace selvage
