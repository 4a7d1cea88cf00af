#include "host/garment/pattern_draft.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include <Eigen/Geometry>

namespace selvage {
namespace {

// Chosen by hand.
const double gap_to_torso = 0.045;     // From the front or back of the torso to the centre line of a panel [m].
const double gap_to_shoulder = 0.055;  // From the shoulder to a sleeve's start position, along the arm [m].

PatternEdge straight(int start, int end) { return {.start = start, .end = end}; }

PatternEdge quadratic(int start, int end, const Vec2& control)
{
    return {.start = start, .end = end, .curve = EdgeCurve::quadratic, .control = {control, Vec2::Zero()}};
}

PatternEdge cubic(int start, int end, const Vec2& first, const Vec2& second)
{
    return {.start = start, .end = end, .curve = EdgeCurve::cubic, .control = {first, second}};
}

Vec2 mirrored(const Vec2& point) { return {-point.x(), point.y()}; }

/// Returns the root of an increasing function between low and high.
double bisect(double low, double high, const std::function<double(double)>& increasing)
{
    for (int halving = 0; halving < 50; ++halving) {
        const double middle = 0.5 * (low + high);
        (increasing(middle) < 0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// Returns the control points of half a sleeve cap from the underarm (width, 0) to the top (0, height): an S-shaped
/// curve with horizontal ends.
std::array<Vec2, 2> cap_controls(double width, double height)
{
    return {Vec2(0.60 * width, 0), Vec2(0.42 * width, height)};
}

double cap_length(double width, double height)
{
    const auto [first, second] = cap_controls(width, height);
    const PatternPanel half{.name = {},
                            .vertices = {{width, 0}, {0, height}},
                            .edges = {cubic(0, 1, first, second)},
                            .wrap = {},
                            .fabric = {}};
    return edge_length(half, 0);
}

/// Returns the width of half a sleeve cap of the given height whose curve is `length` long.
double cap_width(double length, double height)
{
    return bisect(0, length, [&](double width) { return cap_length(width, height) - length; });
}

/// Columns: the panel's x, y and outward normal in the scene.
Mat3 panel_rotation(const Vec3& up, const Vec3& outward)
{
    Mat3 rotation;
    rotation << up.cross(outward), up, outward;
    return rotation;
}

}  // namespace

double edge_length(const PatternPanel& panel, int edge)
{
    const PatternEdge& e = panel.edges[edge];
    const Vec2 a = panel.vertices[e.start], d = panel.vertices[e.end];
    Vec2 b = a + (d - a) / 3, c = d - (d - a) / 3;
    if (e.curve == EdgeCurve::quadratic) {
        b = a + 2.0 / 3.0 * (e.control[0] - a);
        c = d + 2.0 / 3.0 * (e.control[0] - d);
    } else if (e.curve == EdgeCurve::cubic) {
        b = e.control[0];
        c = e.control[1];
    }
    const int chord_count = 256;
    double length = 0;
    Vec2 before = a;
    for (int chord = 1; chord <= chord_count; ++chord) {
        const double t = double(chord) / chord_count, s = 1 - t;
        const Vec2 here = s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d;
        length += (here - before).norm();
        before = here;
    }
    return length;
}

PatternPanel draft_bodice(BodiceSide side, const BodiceStyle& style, const MannequinMeasures& measures,
                          const MannequinLandmarks& landmarks)
{
    const bool front = side == BodiceSide::front;
    const Vec3 body_neck = landmarks.neck_side[0], body_shoulder = landmarks.shoulder_point[0];
    // The panel's slope is slightly flatter than the shoulder's, so that the cloth rests on the shoulder's neck end.
    const double slope = 0.9 * (body_neck.z() - body_shoulder.z()) / (body_shoulder.x() - body_neck.x());
    const Vec2 neck(body_neck.x() + style.neck_ease, 0);
    const double shoulder_x = body_shoulder.x() - style.shoulder_inset;
    const Vec2 shoulder(shoulder_x, -slope * (shoulder_x - neck.x()));
    const double top = body_neck.z() + 0.010;
    const Vec2 underarm(0.25 * (measures.bust + style.bust_ease), landmarks.armpit[0].z() - style.armhole_drop - top);
    const Vec2 hem_corner(style.flare * underarm.x(), -style.length);

    const Vec2 seam = (neck - shoulder).normalized(), across_seam(-seam.y(), seam.x());
    const double scoop = front ? 0.022 : 0.008;
    const Vec2 low_control(shoulder.x() - scoop, underarm.y());
    const Vec2 high_control = shoulder + 0.5 * (shoulder.y() - underarm.y()) * across_seam;
    const Vec2 waist(0.5 * (underarm.x() + hem_corner.x()) - 2 * style.waist_shaping,
                     0.5 * (underarm.y() + hem_corner.y()));
    // The middle of a cubic curve lies at three quarters of the depth of its control points.
    const double depth = (front ? style.front_neck_depth : style.back_neck_depth) / 0.75;
    const Vec2 neck_control((front ? 0.92 : 0.70) * neck.x(), -depth);

    PatternPanel panel;
    panel.name = front ? "front" : "back";
    panel.vertices = {mirrored(hem_corner), hem_corner,         underarm,          shoulder, neck,
                      mirrored(neck),       mirrored(shoulder), mirrored(underarm)};
    panel.edges = {straight(0, 1),
                   quadratic(1, 2, waist),
                   cubic(2, 3, low_control, high_control),
                   straight(3, 4),
                   cubic(4, 5, neck_control, mirrored(neck_control)),
                   straight(5, 6),
                   cubic(6, 7, mirrored(high_control), mirrored(low_control)),
                   quadratic(7, 0, mirrored(waist))};
    panel.rotation = panel_rotation(Vec3::UnitZ(), front ? Vec3(0, -1, 0) : Vec3(0, 1, 0));
    panel.translation = Vec3(0, front ? landmarks.front - gap_to_torso : landmarks.back + gap_to_torso, top);
    panel.wrap = PanelWrap{.radius = 0.95 * underarm.x(), .x0 = 0, .behind = false};
    return panel;
}

PatternPanel draft_sleeve(int hand, const SleeveStyle& style, double front_armhole, double back_armhole,
                          const MannequinLandmarks& landmarks)
{
    const double girth = 2 * std::numbers::pi * landmarks.upper_arm_radius + style.ease;
    const double height = bisect(0.02, 0.95 * std::min(front_armhole, back_armhole), [&](double trial) {
        return girth - cap_width(front_armhole, trial) - cap_width(back_armhole, trial);
    });
    const double front = cap_width(front_armhole, height), back = cap_width(back_armhole, height);
    // Seen from outside with the cap upwards, the left sleeve's front is on the panel's left.
    const double left = hand == 0 ? front : back, right = hand == 0 ? back : front;
    const auto left_controls = cap_controls(left, height), right_controls = cap_controls(right, height);

    PatternPanel panel;
    panel.name = hand == 0 ? "left_sleeve" : "right_sleeve";
    panel.vertices = {
        {style.taper - left, -style.length}, {right - style.taper, -style.length}, {right, 0}, {0, height}, {-left, 0}};
    panel.edges = {straight(0, 1), straight(1, 2), cubic(2, 3, right_controls[0], right_controls[1]),
                   cubic(3, 4, mirrored(left_controls[1]), mirrored(left_controls[0])), straight(4, 0)};

    const double middle = 0.5 * (right - left);
    // The cylinder is wider than the sleeve's girth, so that the underarm edges face each other across a small gap.
    const double radius = 1.06 * (left + right) / (2 * std::numbers::pi);
    const Vec3 along = landmarks.arm_direction[hand];
    const Vec3 outward = Vec3::UnitZ() - along.z() * along;
    panel.rotation = panel_rotation(-along, outward.normalized());
    panel.wrap = PanelWrap{.radius = radius, .x0 = middle, .behind = false};
    const Vec3 base = landmarks.shoulder_joint[hand] + (height + gap_to_shoulder) * along;
    panel.translation = base + panel.rotation * Vec3(-middle, 0, radius);
    return panel;
}

}  // namespace selvage
