#include "host/styles/blocks/bodice_block.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "host/styles/blocks/placement.hpp"

namespace selvage {
namespace {

constexpr double adult_armscye = 0.165;   // depth of the armhole for which a style's drop is meant [m]
constexpr double farthest_sleeve = 0.20;  // from the shoulder to the top of a sleeve at the start [m]

/// Half a neckline: from the shoulder end, x > 0, to the middle, x = 0, with the control points of its curve.
struct Neckline {
    Vec2 end, first, second, middle;
};

// The whole neckline is one cubic curve, of which this is half.
Neckline neckline(bool front, const Vec2& end, double depth)
{
    const Vec2 control((front ? 0.92 : 0.70) * end.x(), (-depth - 0.25 * end.y()) / 0.75);
    const Vec2 first = 0.5 * (end + control), second = 0.5 * (first + Vec2(0, control.y()));
    return {end, first, second, {0, -depth}};
}

double shoulder_slope(const StyleBody& body)
{
    const StyleMeasures& m = body.measures;
    // Slightly flatter than the shoulder, so that the cloth rests on the shoulder's neck end.
    return 0.9 * m.shoulder_drop / (0.5 * (m.shoulder_width - m.neck_width));
}

double neck_end(const BodiceStyle& style, const StyleBody& body)
{
    return 0.5 * body.measures.neck_width + style.neck_ease;
}

double neck_depth(bool front, const BodiceStyle& style)
{
    return front ? style.front_neck_depth : style.back_neck_depth;
}

// The control points of half a sleeve cap from the underarm (width, 0) to the top (0, height): an S-shaped curve with
// level ends.
std::array<Vec2, 2> cap_controls(double width, double height)
{
    return {Vec2(0.60 * width, 0), Vec2(0.42 * width, height)};
}

// The width of half a sleeve cap of the given height whose curve is `length` long.
double cap_width(double length, double height)
{
    return root_of(0, length, [&](double width) {
        const auto [first, second] = cap_controls(width, height);
        return PanelDraft("cap", {width, 0}).curve(first, second, {0, height}, "cap").length("cap") - length;
    });
}

struct ArmAxis {
    Vec3 joint, along, outward;  ///< outward: across the arm, upwards.
};

ArmAxis arm_axis(const StyleBody& body, int side)
{
    const Vec3 joint = 0.5 * (body.shoulder[side] + body.armpit[side]);
    const Vec3 along = (body.wrist[side] - joint).normalized();
    return {joint, along, (Vec3::UnitZ() - along.z() * along).normalized()};
}

}  // namespace

PanelDraft draft_half_bodice(bool front, const BodiceStyle& style, const StyleBody& body)
{
    const StyleMeasures& m = body.measures;
    const Neckline line = neckline(front, {neck_end(style, body), 0}, neck_depth(front, style));
    const double shoulder_x = 0.5 * m.shoulder_width + style.shoulder_extension;
    const Vec2 shoulder(shoulder_x, -shoulder_slope(body) * (shoulder_x - line.end.x()));
    const double drop = style.armscye_drop * std::min(1.0, m.armscye_depth / adult_armscye);
    const Vec2 underarm(0.25 * (m.bust + style.bust_ease), -m.armscye_depth - drop);
    const Vec2 hem(style.flare * underarm.x(), -style.length);
    const Vec2 seam = (line.end - shoulder).normalized(), across_seam(-seam.y(), seam.x());
    const double scoop = front ? 0.022 : 0.008;
    const Vec2 low(shoulder.x() - scoop, underarm.y());
    const Vec2 high = shoulder + 0.5 * (shoulder.y() - underarm.y()) * across_seam;
    const Vec2 waist(0.5 * (underarm.x() + hem.x()) - 2 * style.waist_shaping, 0.5 * (underarm.y() + hem.y()));

    PanelDraft half(front ? "front" : "back", {0, hem.y()});
    half.line(hem, "hem").curve(waist, underarm, "side").curve(low, high, shoulder, "armhole");
    half.line(line.end, "shoulder").curve(line.first, line.second, line.middle, "neck");
    return half;
}

PanelDraft draft_half_neck_band(bool front, const BodiceStyle& style, const StyleBody& body, double width)
{
    const double depth = neck_depth(front, style);
    const Neckline outer = neckline(front, {neck_end(style, body), 0}, depth);
    const Vec2 along = Vec2(-1, shoulder_slope(body)).normalized();
    const Neckline inner = neckline(front, outer.end + width * along, depth - width);
    PanelDraft half(front ? "neck_band_front" : "neck_band_back", outer.middle);
    half.curve(outer.second, outer.first, outer.end, "neck").line(inner.end, "end");
    half.curve(inner.first, inner.second, inner.middle, "edge");
    return half;
}

void place_bodice(PatternPanel& panel, bool front, const StyleBody& body)
{
    hang_around(panel, body.all, {0, body.waist_y, 0}, front ? -Vec3::UnitY() : Vec3(Vec3::UnitY()),
                body.neck_side_height + 0.010);
}

PanelDraft draft_sleeve(const SleeveStyle& style, double front_armhole, double back_armhole, const StyleBody& body)
{
    const double girth = body.measures.upper_arm + style.ease;
    const double height = root_of(0.02, 0.95 * std::min(front_armhole, back_armhole), [&](double trial) {
        return girth - cap_width(front_armhole, trial) - cap_width(back_armhole, trial);
    });
    const double front = cap_width(front_armhole, height), back = cap_width(back_armhole, height);
    const auto front_controls = cap_controls(front, height), back_controls = cap_controls(back, height);
    const double taper = 0.5 * (front + back - style.cuff);
    // Seen from outside with the cap upwards, the left sleeve's front is on the panel's left.
    PanelDraft sleeve("left_sleeve", {taper - front, -style.length});
    sleeve.line({back - taper, -style.length}, "hem").line({back, 0}, "back_under");
    sleeve.curve(back_controls[0], back_controls[1], {0, height}, "back_cap");
    sleeve.curve(mirrored(front_controls[1]), mirrored(front_controls[0]), {-front, 0}, "front_cap");
    return sleeve.close("front_under");
}

double add_sleeves(PatternDraft& garment, const SleeveStyle& style, const StyleBody& body, const Armholes& armholes)
{
    const PanelDraft left =
        draft_sleeve(style, garment.length(armholes.front[0]), garment.length(armholes.back[0]), body);
    const double top = left.panel.vertices[3].y(),
                 middle = 0.5 * (left.panel.vertices[2].x() + left.panel.vertices[4].x());
    const std::vector<Vec3> bodice = placed_outlines(garment.pattern().panels);
    double hem = 0;
    for (const int side : {0, 1}) {
        const std::string hand = side == 0 ? "left" : "right";
        PanelDraft sleeve = side == 0 ? left : mirrored(left, "right_sleeve");
        const auto [joint, along, outward] = arm_axis(body, side);
        for (double beyond = StartGaps::beyond_shoulder; beyond < farthest_sleeve; beyond += 0.01) {
            roll_around(sleeve.panel, body.arm[side], joint + (top + beyond) * along, along, outward,
                        side == 0 ? middle : -middle);
            hem = top + beyond + style.length;
            if (!tube_holds(sleeve.panel, bodice)) break;
        }
        garment.add(sleeve);
        const std::string name = hand + "_sleeve.";
        garment.sew(name + "front_cap", armholes.front[side]);
        garment.sew(name + "back_cap", armholes.back[side]);
        garment.sew(name + "front_under", name + "back_under");
    }
    return hem;
}

void add_cuffs(PatternDraft& garment, const StyleBody& body, double girth, double height, double beyond)
{
    for (const int side : {0, 1}) {
        const std::string hand = side == 0 ? "left" : "right";
        PanelDraft cuff(hand + "_cuff", {-0.5 * girth, -height});
        cuff.line({0.5 * girth, -height}, "edge").line({0.5 * girth, 0}, "end").line({-0.5 * girth, 0}, "sleeve");
        cuff.close("other_end");
        const auto [joint, along, outward] = arm_axis(body, side);
        // Beyond the wrist a cuff would start around the hand and be caught there: it starts within the sleeve.
        const double before_hand = (body.wrist[side] - joint).dot(along) - height;
        roll_around(cuff.panel, body.arm[side], joint + std::min(beyond, before_hand) * along, along, outward);
        garment.add(cuff);
        garment.sew(hand + "_cuff.sleeve", hand + "_sleeve.hem");
        garment.sew(hand + "_cuff.end", hand + "_cuff.other_end");
    }
}

void add_bodice(PatternDraft& garment, const BodiceStyle& style, const StyleBody& body)
{
    for (const bool front : {true, false}) {
        PanelDraft panel = unfolded(draft_half_bodice(front, style, body), front);
        place_bodice(panel.panel, front, body);
        garment.add(panel);
    }
    sew_sides(garment);
}

void sew_sides(PatternDraft& garment)
{
    for (const std::string edge : {"left_shoulder", "right_shoulder", "left_side", "right_side"})
        garment.sew("front." + edge, "back." + edge);
}

}  // namespace selvage
