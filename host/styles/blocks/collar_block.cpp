#include "host/styles/blocks/collar_block.hpp"

#include <algorithm>
#include <cmath>

#include "host/styles/blocks/placement.hpp"

namespace selvage {
namespace {

constexpr double collar_lift = 0.012;  // from the bodice to a collar that lies on it, at the start [m]
constexpr double ends_apart = 0.003;   // from the middle to each end of a collar at the start [m]
constexpr double hood_lift = 0.030;    // of a hood above the sides of the neck at the start [m]
constexpr double hood_ease = 0.06;     // height of a hood beyond that of the head above the neck [m]
constexpr double hood_bulge = 0.05;    // of the back of the head beyond the neckline [m]

Vec3 neck_axis(const StyleBody& body, double height)
{
    return {0, 0.5 * (body.neck_front.y() + body.neck_back.y()), height};
}

// Half a flat collar in the coordinates of the bodice's half, from the middle of its outer edge to that of the neck.
PanelDraft draft_half_collar(const PanelDraft& bodice, bool front, double width, double point)
{
    const std::vector<Vec2>& corners = bodice.panel.vertices;
    const Vec2 shoulder = corners[3], neck = corners[4], middle = corners[5];
    const std::array<Vec2, 2>& control = bodice.panel.edges[4].control;
    const Vec2 at_shoulder = neck + width * (shoulder - neck).normalized();
    const double longer = at_shoulder.x() / neck.x();
    const Vec2 tip = front ? Vec2(0.35 * neck.x(), middle.y() - width - point) : Vec2(0, middle.y() - width);
    PanelDraft half(front ? "left_collar" : "collar_back", front ? middle : tip);
    if (front) half.line(tip, "front");
    half.curve({longer * control[1].x(), tip.y()}, {at_shoulder.x(), 0.5 * (tip.y() + at_shoulder.y())}, at_shoulder,
               "edge");
    half.line(neck, "shoulder").curve(control[0], control[1], middle, "neck");
    return half;
}

// Lays a collar over a placed panel: its outside faces the bodice, as it does when the collar is turned down.
void lay_over(PanelDraft& collar, const PatternPanel& place, double aside)
{
    collar.panel.rotation = place.rotation;
    collar.panel.rotation.col(0) *= -1;
    collar.panel.rotation.col(2) *= -1;
    collar.panel.translation = place.translation + collar_lift * place.rotation.col(2) + aside * place.rotation.col(0);
    collar.panel.wrap = place.wrap;
    collar.panel.wrap->behind = !place.wrap->behind;
}

}  // namespace

void add_flat_collar(PatternDraft& garment, const PanelDraft& front, const PanelDraft& back,
                     const PatternPanel& front_place, const PatternPanel& back_place, double width, double point)
{
    // Turned down, the panels are the mirror images of what is seen from outside: x of the left is at x < 0.
    const PanelDraft half = draft_half_collar(front, true, width, point);
    PanelDraft left = mirrored(half, "left_collar"), right = half;
    right.panel.name = "right_collar";
    PanelDraft behind = unfolded(draft_half_collar(back, false, width, point), true);
    lay_over(left, front_place, ends_apart);
    lay_over(right, front_place, -ends_apart);
    lay_over(behind, back_place, 0);
    garment.add(left);
    garment.add(right);
    garment.add(behind);
    for (const std::string side : {"left", "right"}) {
        garment.sew(side + "_collar.neck", side + "_front.neck");
        garment.sew("collar_back." + side + "_neck", "back." + side + "_neck");
        garment.sew(side + "_collar.shoulder", "collar_back." + side + "_shoulder");
    }
}

void add_hood(PatternDraft& garment, const StyleBody& body, const NeckEdges& front, const NeckEdges& back)
{
    const double front_length = garment.length(front[0]), back_length = garment.length(back[0]);
    const double height = body.measures.stature - body.neck_side_height + hood_ease;
    std::vector<Vec3> points = body.trunk;
    points.insert(points.end(), body.head.begin(), body.head.end());
    // Seen from the wearer's left the face is at x < 0.
    PanelDraft left("left_hood", {-front_length, 0});
    left.line({0, 0}, "front_neck").line({back_length, 0}, "back_neck");
    left.curve({back_length + 2 * hood_bulge, 0.65 * height}, {back_length, 1.08 * height},
               {-0.7 * front_length, height}, "crown");
    left.close("face");
    for (const int side : {0, 1}) {
        PanelDraft half = side == 0 ? left : mirrored(left, "right_hood");
        hang_flat(half.panel, points, neck_axis(body, 0), side == 0 ? Vec3(Vec3::UnitX()) : -Vec3::UnitX(),
                  body.neck_side_height + hood_lift);
        garment.add(half);
        garment.sew(half.panel.name + ".front_neck", front[side]);
        garment.sew(half.panel.name + ".back_neck", back[side]);
    }
    garment.sew("left_hood.crown", "right_hood.crown");
}

}  // namespace selvage
