#include "host/styles/blocks/bodice_block.hpp"
#include "host/styles/style_drafts.hpp"

namespace selvage {

Pattern draft_vest(const StyleBody& body)
{
    const StyleMeasures& m = body.measures;
    BodiceStyle style;
    style.bust_ease = 0.10;
    style.length = m.neck_to_waist + m.waist_to_hips + 0.02;
    style.flare = 1.01;
    style.waist_shaping = 0.012;
    style.neck_ease = 0.018;
    style.front_neck_depth = m.neck_width;
    style.back_neck_depth = 0.035;
    style.shoulder_extension = -0.012;
    style.armscye_drop = 0.045;
    PatternDraft garment;
    add_bodice(garment, style, body);
    return garment.pattern();
}

}  // namespace selvage
