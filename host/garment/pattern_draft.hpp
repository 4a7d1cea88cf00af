#pragma once
#include "host/mannequin/mannequin.hpp"
#include "io/pattern/pattern.hpp"

namespace selvage {

/// The dimensions of a bodice beyond the body's measures [m].
struct BodiceStyle {
    double bust_ease = 0.14;       ///< Girth at the underarm beyond the bust.
    double length = 0.72;          ///< From the neck end of the shoulder down to the hem.
    double flare = 1.03;           ///< Width of the hem over that at the underarm.
    double waist_shaping = 0.008;  ///< How far the side seams bend inwards.
    double neck_ease = 0.012;      ///< Outward shift of the neck end of the shoulder.
    double front_neck_depth = 0.095, back_neck_depth = 0.025;
    double shoulder_inset = 0;    ///< Inward shift of the shoulder's end from the shoulder point.
    double armhole_drop = 0.030;  ///< Depth of the underarm below the armpit.
};

/// The dimensions of a sleeve beyond the arm's measures [m].
struct SleeveStyle {
    double ease = 0.12;    ///< Girth beyond the upper arm's.
    double length = 0.21;  ///< Underarm to hem.
    double taper = 0.025;  ///< Each underarm edge moves inwards by this down to the hem.
};

/// Edges of a bodice panel; `right` is towards the panel's +x.
enum BodiceEdge { hem, side_right, armhole_right, shoulder_right, neckline, shoulder_left, armhole_left, side_left };

/// Edges of a sleeve panel.
enum SleeveEdge { cuff, under_right, cap_right, cap_left, under_left };

enum class BodiceSide { front, back };

/// Drafts and places a front or back, its outline counter-clockwise; y = 0 is the neck end of the shoulder.
PatternPanel draft_bodice(BodiceSide side, const BodiceStyle& style, const MannequinMeasures& measures,
                          const MannequinLandmarks& landmarks);

/// Drafts and places a sleeve whose cap halves are as long as the armhole edges they are sewn to.
/// @param hand           0 for the wearer's left, 1 for the right
/// @param front_armhole, back_armhole  arc lengths [m]
PatternPanel draft_sleeve(int hand, const SleeveStyle& style, double front_armhole, double back_armhole,
                          const MannequinLandmarks& landmarks);

/// Arc length [m] of a straight or Bezier outline edge.
double edge_length(const PatternPanel& panel, int edge);

}  // namespace selvage
