#include "host/garment/catalogue.hpp"

#include <fmt/format.h>

#include "host/garment/pattern_draft.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

constexpr int front_panel = 0, back_panel = 1, left_sleeve_panel = 2, right_sleeve_panel = 3;

/// Front and back, sewn at shoulders and sides. The panels face away from each other: the wearer's left is the
/// front's right and the back's left.
Pattern draft_body(const BodiceStyle& style, const MannequinMeasures& measures, const MannequinLandmarks& landmarks)
{
    Pattern pattern;
    pattern.panels = {draft_bodice(BodiceSide::front, style, measures, landmarks),
                      draft_bodice(BodiceSide::back, style, measures, landmarks)};
    pattern.stitches = {{{front_panel, shoulder_right}, {back_panel, shoulder_left}},
                        {{front_panel, shoulder_left}, {back_panel, shoulder_right}},
                        {{front_panel, side_right}, {back_panel, side_left}},
                        {{front_panel, side_left}, {back_panel, side_right}}};
    return pattern;
}

void add_sleeves(Pattern& pattern, const SleeveStyle& style, const MannequinLandmarks& landmarks)
{
    const double front = edge_length(pattern.panels[front_panel], armhole_right);
    const double back = edge_length(pattern.panels[back_panel], armhole_right);
    for (int hand : {0, 1}) pattern.panels.push_back(draft_sleeve(hand, style, front, back, landmarks));
    const std::vector<PatternStitch> stitches{{{left_sleeve_panel, cap_left}, {front_panel, armhole_right}},
                                              {{left_sleeve_panel, cap_right}, {back_panel, armhole_left}},
                                              {{right_sleeve_panel, cap_right}, {front_panel, armhole_left}},
                                              {{right_sleeve_panel, cap_left}, {back_panel, armhole_right}},
                                              {{left_sleeve_panel, under_right}, {left_sleeve_panel, under_left}},
                                              {{right_sleeve_panel, under_right}, {right_sleeve_panel, under_left}}};
    pattern.stitches.insert(pattern.stitches.end(), stitches.begin(), stitches.end());
}

/// Eases and proportions were chosen by hand.
Pattern draft_tshirt(const MannequinMeasures& measures, const MannequinLandmarks& landmarks)
{
    BodiceStyle style;
    style.bust_ease = 0.16;
    style.length = 0.442 * measures.stature;
    Pattern pattern = draft_body(style, measures, landmarks);
    add_sleeves(pattern, {.ease = 0.13, .length = 0.50 * measures.arm_length}, landmarks);
    return pattern;
}

/// Eases and proportions were chosen by hand.
Pattern draft_vest(const MannequinMeasures& measures, const MannequinLandmarks& landmarks)
{
    BodiceStyle style;
    style.bust_ease = 0.12;
    style.length = 0.37 * measures.stature;
    style.flare = 1.01;
    style.waist_shaping = 0.012;
    style.neck_ease = 0.018;
    style.front_neck_depth = 0.150;
    style.back_neck_depth = 0.035;
    style.shoulder_inset = 0.025;
    style.armhole_drop = 0.035;
    return draft_body(style, measures, landmarks);
}

}  // namespace

std::vector<std::string> builtin_pattern_names() { return {"tshirt", "vest"}; }

Pattern builtin_pattern(const std::string& name, BodySize size)
{
    const MannequinMeasures measures = mannequin_size(size);
    const MannequinLandmarks landmarks = mannequin_landmarks(measures);
    Pattern pattern;
    if (name == "tshirt") {
        pattern = draft_tshirt(measures, landmarks);
    } else if (name == "vest") {
        pattern = draft_vest(measures, landmarks);
    } else {
        InputPlace place;
        place.key = "garment.pattern";
        const std::vector<std::string> names = builtin_pattern_names();
        throw InputError(place, fmt::format("\"{}\"", name), "a built-in pattern: tshirt or vest",
                         nearest_name(name, names));
    }
    pattern.name = name;
    return pattern;
}

}  // namespace selvage
