#include "host/styles/blocks/skirt_block.hpp"

#include "host/styles/blocks/placement.hpp"

namespace selvage {

void add_waistband(PatternDraft& garment, const StyleBody& body, double girth)
{
    const double half = girth / 4;
    for (const bool front : {true, false}) {
        const std::string plus = front ? "left" : "right", minus = front ? "right" : "left";
        PanelDraft band(front ? "waistband_front" : "waistband_back", Vec2(-half, 0));
        band.line({0, 0}, "bottom_" + minus).line({half, 0}, "bottom_" + plus);
        band.line({half, waistband_height}, plus);
        band.line({-half, waistband_height}, "top");
        band.close(minus);
        hang_around(band.panel, body.trunk, {0, body.waist_y, 0}, front ? -Vec3::UnitY() : Vec3(Vec3::UnitY()),
                    body.waist_height);
        garment.add(band);
    }
    garment.sew("waistband_front.left", "waistband_back.left");
    garment.sew("waistband_front.right", "waistband_back.right");
}

}  // namespace selvage
