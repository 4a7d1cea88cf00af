#include "host/styles/blocks/bodice_block.hpp"
#include "host/styles/blocks/placement.hpp"
#include "host/styles/blocks/skirt_block.hpp"
#include "host/styles/style_drafts.hpp"

namespace selvage {
namespace {

// Eases and darts of a close fit, after Aldrich's bodice and skirt blocks [m].
constexpr double bust_ease = 0.08, waist_ease = 0.04, hip_ease = 0.06, hem_flare = 0.05;
constexpr double bust_dart = 0.028;      // width at the side
constexpr double dart_to_point = 0.025;  // the ends of darts stay off the point of the bust
constexpr Dart front_dart{.at = 0.45, .width = 0.03, .depth = 0.10};
constexpr Dart back_dart{.at = 0.45, .width = 0.03, .depth = 0.14};
constexpr Dart skirt_front_dart{.at = 0.45, .width = 0.02, .depth = 0.09};
constexpr Dart skirt_back_dart{.at = 0.45, .width = 0.03, .depth = 0.12};

double quarter_waist(const StyleMeasures& m) { return (m.waist + waist_ease) / 4; }

/// Adds a bust dart to the bodice's front, whose side it lengthens by the width of the dart.
PanelDraft draft_bodice_half(bool front, const BodiceStyle& style, const StyleBody& body)
{
    const StyleMeasures& m = body.measures;
    // The block's armhole, shoulder and neck stand on a side and waist of this style's own.
    const PanelDraft block = draft_half_bodice(front, style, body);
    const Vec2 underarm = block.panel.vertices[2];
    const double waist_y = -m.neck_to_waist - (front ? bust_dart : 0);
    const Dart& dart = front ? front_dart : back_dart;
    const Vec2 side(quarter_waist(m) + dart.width, waist_y);
    PanelDraft half(front ? "front" : "back", {0, waist_y});
    add_waistline(half, side, dart, false);
    if (front) {
        const double bust_x = 0.1 * m.bust, bust_y = body.bust_height - body.neck_side_height;
        const Vec2 down = (side - underarm).normalized();
        const Vec2 high = underarm + 0.045 * down, low = high + bust_dart * down;
        half.line(low, "side_low").line({bust_x + dart_to_point, bust_y}, "bust_dart_0");
        half.line(high, "bust_dart_1").line(underarm, "side_high");
    } else {
        const Vec2 up = (underarm - side).normalized();
        half.line(underarm - 0.045 * up, "side_low").line(underarm, "side_high");
    }
    const std::vector<PatternEdge>& edges = block.panel.edges;
    const std::vector<Vec2>& corners = block.panel.vertices;
    half.curve(edges[2].control[0], edges[2].control[1], corners[3], "armhole").line(corners[4], "shoulder");
    half.curve(edges[4].control[0], edges[4].control[1], corners[5], "neck");
    return half;
}

PanelDraft draft_skirt_half(bool front, const StyleMeasures& m)
{
    const double hip = (m.hips + hip_ease) / 4, length = m.waist_to_knee;
    const Dart& dart = front ? skirt_front_dart : skirt_back_dart;
    const Vec2 waist(quarter_waist(m) + dart.width, 0.0125);
    PanelDraft half(front ? "skirt_front" : "skirt_back", {0, -length});
    half.line({hip + hem_flare, -length}, "hem").line({hip, -m.waist_to_hips}, "side_low");
    half.curve({hip, -0.45 * m.waist_to_hips}, waist, "side_high");
    add_waistline(half, {0, 0}, dart, true);
    return half;
}

}  // namespace

Pattern draft_dress(const StyleBody& body)
{
    const StyleMeasures& m = body.measures;
    BodiceStyle style;
    style.bust_ease = bust_ease;
    style.neck_ease = 0.03;
    style.front_neck_depth = 0.5 * m.neck_width + 0.03;
    style.back_neck_depth = 0.03;
    style.shoulder_extension = -0.015;
    style.armscye_drop = 0.030;
    PatternDraft garment;
    for (const bool front : {true, false}) {
        PanelDraft bodice = unfolded(draft_bodice_half(front, style, body), front);
        place_bodice(bodice.panel, front, body);
        PanelDraft skirt = unfolded(draft_skirt_half(front, m), front);
        hang_around(skirt.panel, below_waist(body), {0, body.waist_y, 0}, front ? -Vec3::UnitY() : Vec3(Vec3::UnitY()),
                    body.waist_height - 0.03);
        garment.add(bodice);
        garment.add(skirt);
        for (const std::string side : {".left_", ".right_"}) {
            const std::string up = bodice.panel.name + side, down = skirt.panel.name + side;
            garment.sew(up + "waist_0", down + "waist_0");
            garment.sew(up + "waist_1", down + "waist_1");
            garment.sew(up + "dart_0", up + "dart_1");
            garment.sew(down + "dart_0", down + "dart_1");
            if (front) garment.sew(up + "bust_dart_0", up + "bust_dart_1");
        }
    }
    for (const std::string side : {"left_", "right_"}) {
        garment.sew("front." + side + "shoulder", "back." + side + "shoulder");
        for (const std::string edge : {"side_low", "side_high"}) {
            garment.sew("front." + side + edge, "back." + side + edge);
            garment.sew("skirt_front." + side + edge, "skirt_back." + side + edge);
        }
    }
    return garment.pattern();
}

}  // namespace selvage
