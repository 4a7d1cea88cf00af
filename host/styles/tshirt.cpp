#include "host/styles/blocks/bodice_block.hpp"
#include "host/styles/blocks/placement.hpp"
#include "host/styles/style_drafts.hpp"

namespace selvage {
namespace {

constexpr double band_width = 0.022;  // of the neck band [m]

}  // namespace

Pattern draft_tshirt(const StyleBody& body)
{
    const StyleMeasures& m = body.measures;
    BodiceStyle style;
    style.bust_ease = 0.14;
    style.length = m.neck_to_waist + m.body_rise + 0.02;  // to the crotch
    style.flare = 1.0;
    style.neck_ease = 0.010 + band_width;
    style.front_neck_depth = 0.5 * m.neck_width + 0.015 + band_width;
    style.back_neck_depth = 0.012 + band_width;
    style.shoulder_extension = 0.025;
    style.armscye_drop = 0.060;
    PatternDraft garment;
    for (const bool front : {true, false}) {
        PanelDraft panel = unfolded(draft_half_bodice(front, style, body), front);
        place_bodice(panel.panel, front, body);
        PanelDraft band = unfolded(draft_half_neck_band(front, style, body, band_width), front);
        place_like(band.panel, panel.panel);
        garment.add(panel);
        garment.add(band);
        for (const std::string neck : {".left_neck", ".right_neck"})
            garment.sew(band.panel.name + neck, panel.panel.name + neck);
    }
    sew_sides(garment);
    for (const std::string end : {"left_end", "right_end"})
        garment.sew("neck_band_front." + end, "neck_band_back." + end);
    add_sleeves(garment, {.ease = 0.13, .length = 0.13, .cuff = m.upper_arm + 0.09}, body);
    return garment.pattern();
}

}  // namespace selvage
