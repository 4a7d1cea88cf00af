#include <algorithm>
#include <cmath>

#include "host/styles/blocks/placement.hpp"
#include "host/styles/blocks/skirt_block.hpp"
#include "host/styles/style_drafts.hpp"

namespace selvage {
namespace {

// Aldrich, classic tailored trousers: of each of her two darts of the back the half of the width, in one.
constexpr Dart full_front_dart{.at = 0.5, .width = 0.02, .depth = 0.10};
constexpr Dart full_back_dart{.at = 0.5, .width = 0.035, .depth = 0.12};

constexpr double rise_ease = 0.015;   // of the crotch below the body's [m]; Aldrich's rise is measured sitting
constexpr double hem_of_ankle = 1.9;  // girth of the hem over that of the ankle
constexpr double off_ground = 0.075;  // of the hem [m]
constexpr double middle_gap = 0.004;  // from the middle of the body to the panels of a leg at the start [m]

/// The levels and widths that front and back share. x = 0 is the crease, y = 0 the waist.
struct LegDraft {
    double hips = 0, waist = 0;  // girths
    double hip_y = 0, crotch_y = 0, knee_y = 0, hem_y = 0;
    double middle_x = 0;       // |x| of the upright line through the middle of the body
    double hem = 0, knee = 0;  // half widths of the front
    Dart front_dart, back_dart;
};

LegDraft leg_of(const StyleMeasures& m)
{
    LegDraft leg;
    leg.hips = m.hips;
    leg.waist = m.waist;
    leg.hip_y = -m.waist_to_hips;
    leg.crotch_y = -m.body_rise - rise_ease;
    leg.hem_y = -(m.body_rise + m.inside_leg - off_ground);
    leg.knee_y = 0.5 * (leg.crotch_y + leg.hem_y) + 0.05;
    leg.middle_x = m.hips / 12 + 0.015;
    leg.hem = 0.25 * hem_of_ankle * m.ankle - 0.005;
    leg.knee = leg.hem + 0.013;
    // Aldrich's hips are 26 cm above the waist; darts of straighter figures, as of children, are narrower.
    const double share = std::clamp((m.hips - m.waist) / 0.26, 0.25, 1.0);
    leg.front_dart = full_front_dart;
    leg.back_dart = full_back_dart;
    leg.front_dart.width *= share;
    leg.back_dart.width *= share;
    return leg;
}

/// The free lengths of a panel: with those of the back its seams become as long as the front's.
struct LegFit {
    double crotch_drop = 0;  // of the crotch's tip below the crotch line
    double side_rise = 0;    // of the side above the waistline
};

// The left leg's front, its side at x > 0. Edges: `hem`, `side_leg`, `side_hip`, the waistline, `centre`, `inseam`.
PanelDraft draft_front(const LegDraft& leg)
{
    const double tip = leg.middle_x + leg.hips / 16 + 0.005;
    const double hip = leg.hips / 4 + 0.005 - leg.middle_x;
    const Vec2 centre(-leg.middle_x + 0.01, 0), on_hip(-leg.middle_x, leg.hip_y);
    PanelDraft panel("left_front", {-leg.hem, leg.hem_y});
    panel.line({leg.hem, leg.hem_y}, "hem");
    panel.curve({leg.knee, leg.knee_y}, {hip, 0.5 * (leg.hip_y + leg.crotch_y)}, {hip, leg.hip_y}, "side_leg");
    const Vec2 side(centre.x() + leg.waist / 4 + 0.0025 + leg.front_dart.width, 0);
    panel.curve({hip, 0.5 * leg.hip_y}, side, "side_hip");
    add_waistline(panel, centre, leg.front_dart, true);
    panel.line(on_hip, "centre_high");
    panel.curve({-leg.middle_x, leg.crotch_y + 0.01}, {-tip, leg.crotch_y}, "centre_low");
    panel.curve({-leg.knee - 0.01, leg.knee_y}, {-leg.hem, leg.hem_y}, "inseam");
    return panel;
}

PanelDraft draft_back(const LegDraft& leg, const LegFit& fit)
{
    const double line_x = 0.75 * leg.middle_x;  // of the upright line through the seat, from the crease inwards
    const double tip = leg.middle_x + 1.5 * (leg.hips / 16 + 0.005);
    const double hip = leg.hips / 4 + 0.015 - line_x;
    const double hem = leg.hem + 0.01, knee = leg.knee + 0.01;
    const Vec2 centre(-line_x + 0.02, 0.02), seat(-line_x, 0.5 * leg.crotch_y);
    PanelDraft panel("left_back", {-hem, leg.hem_y});
    // Drawn with the side at x > 0 like the front; the panel is its mirror image.
    panel.line({hem, leg.hem_y}, "hem");
    panel.curve({knee, leg.knee_y}, {hip, 0.5 * (leg.hip_y + leg.crotch_y)}, {hip, leg.hip_y}, "side_leg");
    const double across = leg.waist / 4 + 0.0025 + leg.back_dart.width;
    const double side_y = fit.side_rise;
    const Vec2 side(centre.x() + std::sqrt(across * across - (centre.y() - side_y) * (centre.y() - side_y)), side_y);
    panel.curve({hip, 0.5 * leg.hip_y}, side, "side_hip");
    add_waistline(panel, centre, leg.back_dart, true);
    panel.line(seat, "centre_high");
    panel.curve({-line_x - 0.005, leg.crotch_y + 0.01}, {-tip, leg.crotch_y - fit.crotch_drop}, "centre_low");
    panel.curve({-knee - 0.015, leg.knee_y}, {-hem, leg.hem_y}, "inseam");
    return panel;
}

// The back whose inseam and side are as long as the front's.
PanelDraft draft_fitting_back(const LegDraft& leg, const PanelDraft& front)
{
    LegFit fit;
    fit.crotch_drop = -root_of(-0.06, 0.06, [&](double lift) {
        return draft_back(leg, {-lift, 0}).length("inseam") - front.length("inseam");
    });
    fit.side_rise = root_of(-0.05, 0.05, [&](double rise) {
        return draft_back(leg, {fit.crotch_drop, rise}).length("side_hip") - front.length("side_hip");
    });
    return draft_back(leg, fit);
}

// Places a panel of a leg beside it, on its side of the middle of the body.
void place_leg(PatternPanel& panel, const StyleBody& body, const std::vector<Vec3>& points, bool front, bool left)
{
    const Vec3 outward = front ? -Vec3::UnitY() : Vec3(Vec3::UnitY());
    const Vec2& first = panel.vertices.front();
    double low = first.x(), high = first.x();
    for (const Vec2& vertex : panel.vertices) {
        low = std::min(low, vertex.x());
        high = std::max(high, vertex.x());
    }
    const double middle = 0.5 * (low + high), sign = left ? 1 : -1;
    double axis = 0.5 * (high - low);
    for (int round = 0; round < 6; ++round) {
        hang_around(panel, points, {sign * axis, body.waist_y, 0}, outward, body.waist_height, middle);
        axis = panel.wrap->radius * std::sin(std::min(1.57, 0.5 * (high - low) / panel.wrap->radius)) + middle_gap;
    }
    hang_around(panel, points, {sign * axis, body.waist_y, 0}, outward, body.waist_height, middle);
}

}  // namespace

Pattern draft_trousers(const StyleBody& body)
{
    const LegDraft leg = leg_of(body.measures);
    const PanelDraft front = draft_front(leg), back = draft_fitting_back(leg, front);
    const std::vector<Vec3> points = below_waist(body);
    PatternDraft garment;
    add_waistband(garment, body, leg.waist + 0.01, leg.front_dart.at, leg.back_dart.at);
    for (const std::string side : {"left", "right"}) {
        const bool left = side == "left";
        PanelDraft front_panel = left ? front : mirrored(front, "right_front");
        PanelDraft back_panel = left ? mirrored(back, "left_back") : back;
        back_panel.panel.name = side + "_back";
        place_leg(front_panel.panel, body, points, true, left);
        place_leg(back_panel.panel, body, points, false, left);
        garment.add(front_panel);
        garment.add(back_panel);
        for (const std::string edge : {".side_leg", ".side_hip", ".inseam"})
            garment.sew(side + "_front" + edge, side + "_back" + edge);
        for (const std::string part : {"front", "back"}) {
            const std::string panel = side + "_" + part + ".";
            garment.sew(panel + "dart_0", panel + "dart_1");
            for (const std::string edge : {"0", "1"})
                garment.sew(panel + "waist_" + edge, "waistband_" + part + "." + side + "_" + edge);
        }
    }
    for (const std::string edge : {"_front.centre_high", "_front.centre_low", "_back.centre_high", "_back.centre_low"})
        garment.sew("left" + edge, "right" + edge);
    return garment.pattern();
}

}  // namespace selvage
