#include "host/styles/blocks/collar_block.hpp"

#include <algorithm>
#include <cmath>

#include "host/styles/blocks/placement.hpp"

namespace selvage {
namespace {

constexpr double stand_lift = 0.030;   // of a stand above the sides of the neck at the start [m]
constexpr double fall_around = 0.014;  // from the stand to the fall that hangs around it [m]
// The fall starts so far above the foot of the stand that its seam closes after those of the neckline: lower it would
// be in their way [m].
constexpr double fall_lift = 0.10;
constexpr double fall_radius = 0.70;  // of the seam of the fall [m]
constexpr double hood_lift = 0.030;   // of a hood above the sides of the neck at the start [m]
constexpr double hood_ease = 0.06;    // height of a hood beyond that of the head above the neck [m]
constexpr double hood_bulge = 0.05;   // of the back of the head beyond the neckline [m]

Vec3 neck_axis(const StyleBody& body, double height)
{
    return {0, 0.5 * (body.neck_front.y() + body.neck_back.y()), height};
}

// Adds the lower edge of a strip around the neck, from the left of the front around the back to the right.
void add_neck_edge(PanelDraft& strip, const std::array<double, 4>& lengths)
{
    const std::array<const char*, 4> names{"left_front", "left_back", "right_back", "right_front"};
    for (int k = 0; k < 4; ++k) {
        const Vec2 from = strip.panel.vertices.back();
        strip.line({from.x() + lengths[k], 0}, names[k]);
    }
}

}  // namespace

void add_collar(PatternDraft& garment, const StyleBody& body, const NeckEdges& front, const NeckEdges& back,
                const CollarStyle& style)
{
    const double front_length = garment.length(front[0]), back_length = garment.length(back[0]);
    const double half = front_length + back_length;
    const std::array<double, 4> lengths{front_length, back_length, back_length, front_length};
    PanelDraft stand("collar_stand", {-half, 0});
    add_neck_edge(stand, lengths);
    stand.line({half, style.stand}, "right_end").line({-half, style.stand}, "top").close("left_end");
    // The fall is a part of a ring: its free edge goes around the stand and is longer than the sewn one.
    const double turn = half / fall_radius, outer = fall_radius + style.fall;
    const Vec2 end(std::sin(turn), std::cos(turn)), centre(0, -fall_radius);
    PanelDraft fall("collar", centre + fall_radius * mirrored(end));
    fall.arc(fall_radius, false, centre + fall_radius * end, "stand");
    fall.line(centre + (outer + style.point) * end, "right_end");
    fall.curve(centre + outer * Vec2(std::sin(0.6 * turn), std::cos(0.6 * turn)) / std::cos(0.1 * turn),
               centre + outer * Vec2(-std::sin(0.6 * turn), std::cos(0.6 * turn)) / std::cos(0.1 * turn),
               centre + (outer + style.point) * mirrored(end), "edge");
    fall.close("left_end");

    std::vector<Vec3> neck = body.trunk;
    neck.insert(neck.end(), body.head.begin(), body.head.end());
    const double bottom = body.neck_side_height + stand_lift;
    roll_around(stand.panel, neck, neck_axis(body, bottom), -Vec3::UnitZ(), Vec3::UnitY(), 0, StartGaps::neck);
    // The fall hangs down, its outside towards the neck.
    const double top = bottom + style.fall + style.point + fall_lift;
    roll_around(fall.panel, neck, neck_axis(body, top), Vec3::UnitZ(), Vec3::UnitY(), 0, StartGaps::neck);
    const double radius = std::max(fall.panel.wrap->radius, stand.panel.wrap->radius + fall_around);
    fall.panel.rotation = stand.panel.rotation;
    fall.panel.rotation.col(1) *= -1;
    fall.panel.rotation.col(2) *= -1;
    fall.panel.translation = neck_axis(body, top) + radius * Vec3::UnitY();
    fall.panel.wrap = PanelWrap{.radius = radius, .x0 = 0, .behind = true};
    garment.add(stand);
    garment.add(fall);
    for (const int side : {0, 1}) {
        const std::string name = side == 0 ? "collar_stand.left_" : "collar_stand.right_";
        garment.sew(name + "front", front[side]);
        garment.sew(name + "back", back[side]);
    }
    garment.sew("collar_stand.left_end", "collar_stand.right_end");
    garment.sew("collar_stand.top", "collar.stand");
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
