#include "host/styles/blocks/bodice_block.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "host/styles/blocks/placement.hpp"

namespace selvage {
namespace {

/// Half a neckline: its shoulder end at x > 0 and the control point of its curve.
struct Neckline {
    Vec2 end, control;
};

// The middle of a cubic curve lies at a quarter of the height of its ends and three quarters of that of its controls.
Neckline neckline(bool front, const Vec2& end, double depth)
{
    return {end, {(front ? 0.92 : 0.70) * end.x(), (-depth - 0.25 * end.y()) / 0.75}};
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

}  // namespace

PanelDraft draft_bodice(bool front, const BodiceStyle& style, const StyleBody& body)
{
    const StyleMeasures& m = body.measures;
    const Vec2 neck(neck_end(style, body), 0);
    const double shoulder_x = 0.5 * m.shoulder_width + style.shoulder_extension;
    const Vec2 shoulder(shoulder_x, -shoulder_slope(body) * (shoulder_x - neck.x()));
    const Vec2 underarm(0.25 * (m.bust + style.bust_ease), -m.armscye_depth - style.armscye_drop);
    const Vec2 hem(style.flare * underarm.x(), -style.length);
    const Vec2 seam = (neck - shoulder).normalized(), across_seam(-seam.y(), seam.x());
    const double scoop = front ? 0.022 : 0.008;
    const Vec2 low(shoulder.x() - scoop, underarm.y());
    const Vec2 high = shoulder + 0.5 * (shoulder.y() - underarm.y()) * across_seam;
    const Vec2 waist(0.5 * (underarm.x() + hem.x()) - 2 * style.waist_shaping, 0.5 * (underarm.y() + hem.y()));
    const Vec2 neck_control = neckline(front, neck, neck_depth(front, style)).control;
    const std::string plus = front ? "left_" : "right_", minus = front ? "right_" : "left_";

    PanelDraft panel(front ? "front" : "back", mirrored(hem));
    panel.line(hem, "hem").curve(waist, underarm, plus + "side").curve(low, high, shoulder, plus + "armhole");
    panel.line(neck, plus + "shoulder").curve(neck_control, mirrored(neck_control), mirrored(neck), "neck");
    panel.line(mirrored(shoulder), minus + "shoulder");
    panel.curve(mirrored(high), mirrored(low), mirrored(underarm), minus + "armhole");
    panel.curve(mirrored(waist), mirrored(hem), minus + "side");
    return panel;
}

PanelDraft draft_neck_band(bool front, const BodiceStyle& style, const StyleBody& body, double width)
{
    const double depth = neck_depth(front, style);
    const Neckline outer = neckline(front, {neck_end(style, body), 0}, depth);
    const Vec2 along = Vec2(-1, shoulder_slope(body)).normalized();
    const Neckline inner = neckline(front, outer.end + width * along, depth - width);
    const std::string plus = front ? "left_end" : "right_end", minus = front ? "right_end" : "left_end";
    PanelDraft band(front ? "neck_band_front" : "neck_band_back", mirrored(outer.end));
    band.curve(mirrored(outer.control), outer.control, outer.end, "neck").line(inner.end, plus);
    band.curve(inner.control, mirrored(inner.control), mirrored(inner.end), "edge").close(minus);
    return band;
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
    const double taper = 0.5 * (girth - style.cuff);
    // Seen from outside with the cap upwards, the left sleeve's front is on the panel's left.
    PanelDraft sleeve("left_sleeve", {taper - front, -style.length});
    sleeve.line({back - taper, -style.length}, "hem").line({back, 0}, "back_under");
    sleeve.curve(back_controls[0], back_controls[1], {0, height}, "back_cap");
    sleeve.curve(mirrored(front_controls[1]), mirrored(front_controls[0]), {-front, 0}, "front_cap");
    return sleeve.close("front_under");
}

void add_sleeves(PatternDraft& garment, const SleeveStyle& style, const StyleBody& body)
{
    const PanelDraft left =
        draft_sleeve(style, garment.length("front.left_armhole"), garment.length("back.left_armhole"), body);
    const double top = left.panel.vertices[3].y(),
                 middle = 0.5 * (left.panel.vertices[2].x() + left.panel.vertices[4].x());
    for (const int side : {0, 1}) {
        const std::string hand = side == 0 ? "left" : "right";
        PanelDraft sleeve = side == 0 ? left : mirrored(left, "right_sleeve");
        const Vec3 joint = 0.5 * (body.shoulder[side] + body.armpit[side]);
        const Vec3 along = (body.wrist[side] - joint).normalized();
        const Vec3 outward = (Vec3::UnitZ() - along.z() * along).normalized();
        roll_around(sleeve.panel, body.arm[side], joint + (top + StartGaps::beyond_shoulder) * along, along, outward,
                    side == 0 ? middle : -middle);
        garment.add(sleeve);
        const std::string name = hand + "_sleeve.";
        garment.sew(name + "front_cap", "front." + hand + "_armhole");
        garment.sew(name + "back_cap", "back." + hand + "_armhole");
        garment.sew(name + "front_under", name + "back_under");
    }
}

}  // namespace selvage
