#include "host/styles/blocks/skirt_block.hpp"

#include "host/styles/blocks/placement.hpp"

namespace selvage {

void add_waistline(PanelDraft& draft, const Vec2& end, const Dart& dart, bool to_middle)
{
    const Vec2 start = draft.panel.vertices.back(), whole = end - start, along = whole.normalized();
    const Vec2 inwards(-along.y(), along.x());
    const double before = (whole.norm() - dart.width) * (to_middle ? 1 - dart.at : dart.at);
    const Vec2 mouth = start + before * along;
    draft.line(mouth, to_middle ? "waist_1" : "waist_0");
    draft.line(mouth + 0.5 * dart.width * along + dart.depth * inwards, "dart_0");
    draft.line(mouth + dart.width * along, "dart_1").line(end, to_middle ? "waist_0" : "waist_1");
}

void add_waistband(PatternDraft& garment, const StyleBody& body, double girth, double front, double back)
{
    for (const bool is_front : {true, false}) {
        const double half = girth / 4, divided = half * (is_front ? front : back);
        PanelDraft band(is_front ? "waistband_front" : "waistband_back", Vec2(0, 0));
        band.line({divided, 0}, "0");
        if (divided < half) band.line({half, 0}, "1");
        band.line({half, waistband_height}, "end");
        band.line({0, waistband_height}, "top");
        band = unfolded(band, is_front);
        hang_around(band.panel, body.trunk, {0, body.waist_y, 0}, is_front ? -Vec3::UnitY() : Vec3(Vec3::UnitY()),
                    body.waist_height);
        garment.add(band);
    }
    garment.sew("waistband_front.left_end", "waistband_back.left_end");
    garment.sew("waistband_front.right_end", "waistband_back.right_end");
}

std::vector<Vec3> below_waist(const StyleBody& body)
{
    std::vector<Vec3> points = body.trunk;
    for (const std::vector<Vec3>& leg : body.leg) points.insert(points.end(), leg.begin(), leg.end());
    return points;
}

}  // namespace selvage
