#include <algorithm>

#include "host/styles/blocks/bodice_block.hpp"
#include "host/styles/blocks/placement.hpp"
#include "host/styles/blocks/skirt_block.hpp"
#include "host/styles/style_drafts.hpp"

namespace selvage {
namespace {

// Eases and darts of a close fit, after Aldrich's bodice and skirt blocks [m].
constexpr double bust_ease = 0.10, waist_ease = 0.04, hip_ease = 0.06, hem_flare = 0.05;
constexpr double bust_dart = 0.028;                    // width at the side
constexpr double bust_dart_drop = 0.045;               // from the underarm to the dart
constexpr double dart_to_point = 0.025;                // the ends of darts stay off the point of the bust
constexpr Dart front_dart{.at = 0.45, .width = 0.03};  // up to the point of the bust
constexpr Dart back_dart{.at = 0.45, .width = 0.03, .depth = 0.14};
constexpr Dart skirt_front_dart{.at = 0.45, .width = 0.02, .depth = 0.09};
constexpr Dart skirt_back_dart{.at = 0.45, .width = 0.03, .depth = 0.12};

// How much of their width darts take: the whole on the figure of Aldrich's table, whose bust is 20 cm and whose hips
// are 26 cm above the waist, less on straighter ones, as of children.
double curve_of(double girth, const StyleMeasures& m, double drop)
{
    return std::clamp((girth - m.waist) / drop, 0.25, 1.0);
}

Dart scaled(Dart dart, double share)
{
    dart.width *= share;
    return dart;
}

double quarter_waist(const StyleMeasures& m) { return (m.waist + waist_ease) / 4; }

/// Adds a bust dart to the bodice's front, whose side it lengthens by the width of the dart.
PanelDraft draft_bodice_half(bool front, const BodiceStyle& style, const StyleBody& body)
{
    const StyleMeasures& m = body.measures;
    // The block's armhole, shoulder and neck stand on a side and waist of this style's own.
    const PanelDraft block = draft_half_bodice(front, style, body);
    const Vec2 underarm = block.panel.vertices[2];
    const double share = curve_of(m.bust, m, 0.20), mouth = share * bust_dart;
    const double waist_y = -m.neck_to_waist - (front ? mouth : 0);
    Dart dart = scaled(front ? front_dart : back_dart, share);
    if (front) dart.depth = std::max(0.03, body.bust_height - body.waist_height + mouth - dart_to_point);
    const Vec2 side(quarter_waist(m) + dart.width, waist_y);
    PanelDraft half(front ? "front" : "back", {0, waist_y});
    add_waistline(half, side, dart, false);
    const Vec2 up = (underarm - side).normalized(), inwards(-up.y(), up.x());
    const Vec2 high = underarm - bust_dart_drop * up;
    if (front) {
        const Vec2 low = high - mouth * up;
        const double depth = std::max(0.03, high.x() - 0.1 * m.bust - dart_to_point);
        half.line(low, "side_low").line(0.5 * (high + low) + depth * inwards, "bust_dart_0");
        half.line(high, "bust_dart_1").line(underarm, "side_high");
    } else {
        half.line(high, "side_low").line(underarm, "side_high");
    }
    const std::vector<PatternEdge>& edges = block.panel.edges;
    const std::vector<Vec2>& corners = block.panel.vertices;
    half.curve(edges[2].control[0], edges[2].control[1], corners[3], "armhole").line(corners[4], "shoulder");
    half.curve(edges[4].control[0], edges[4].control[1], corners[5], "neck");
    return half;
}

/// @param side_rise  height of the side above the middle at the waist
PanelDraft draft_skirt_half(bool front, double side_rise, const StyleMeasures& m)
{
    const double hip = (m.hips + hip_ease) / 4, length = m.waist_to_knee;
    const Dart dart = scaled(front ? skirt_front_dart : skirt_back_dart, curve_of(m.hips, m, 0.26));
    const Vec2 waist(quarter_waist(m) + dart.width, side_rise);
    PanelDraft half(front ? "skirt_front" : "skirt_back", {0, -length});
    half.line({hip + hem_flare, -length}, "hem").line({hip, -m.waist_to_hips}, "side_low");
    half.curve({hip, -0.45 * m.waist_to_hips}, waist, "side_high");
    add_waistline(half, {0, 0}, dart, true);
    return half;
}

// The back's side becomes as long as the front's.
PanelDraft draft_skirt(bool front, const StyleMeasures& m)
{
    const double side_rise = 0.0125;
    const PanelDraft front_half = draft_skirt_half(true, side_rise, m);
    if (front) return unfolded(front_half, true);
    const double fitting = root_of(-0.02, 0.06, [&](double rise) {
        return draft_skirt_half(false, rise, m).length("side_high") - front_half.length("side_high");
    });
    return unfolded(draft_skirt_half(false, fitting, m), false);
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
    style.armscye_drop = 0.045;
    PatternDraft garment;
    for (const bool front : {true, false}) {
        PanelDraft bodice = unfolded(draft_bodice_half(front, style, body), front);
        place_bodice(bodice.panel, front, body);
        PanelDraft skirt = draft_skirt(front, m);
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
