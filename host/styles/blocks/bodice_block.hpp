#pragma once
#include <array>
#include <string>

#include "host/styles/blocks/draft.hpp"
#include "host/styles/blocks/style_measures.hpp"

namespace selvage {

/// The dimensions of a bodice without darts beyond the body's measures [m].
struct BodiceStyle {
    double bust_ease = 0.14;       ///< Girth at the underarm beyond the bust.
    double length = 0.70;          ///< From the neck end of the shoulder down to the hem.
    double flare = 1.03;           ///< Width of the hem over that at the underarm.
    double waist_shaping = 0.008;  ///< How far the side seams bend inwards.
    double neck_ease = 0.012;      ///< From the side of the neck out to the neck end of the shoulder.
    double front_neck_depth = 0.095, back_neck_depth = 0.025;  ///< Below the neck end of the shoulder.
    double shoulder_extension = 0;                             ///< Outward shift from the shoulder point.
    double armscye_drop = 0.030;                               ///< Depth of the underarm below the armpit, of an adult.
};

/// Returns half of the front or back of a bodice, x >= 0, from the middle of the hem to the middle of the neck; y = 0
/// is the neck end of the shoulder. Edges: `hem`, `side`, `armhole`, `shoulder`, `neck`.
PanelDraft draft_half_bodice(bool front, const BodiceStyle& style, const StyleBody& body);

/// Returns half of a band that follows the neckline of draft_half_bodice() inwards, in the coordinates of that panel.
/// Edges: `neck`, which is sewn to the bodice's, `end`, `edge`.
/// @param width  of the band [m]
PanelDraft draft_half_neck_band(bool front, const BodiceStyle& style, const StyleBody& body, double width);

/// Places the front or back of a garment of the upper body.
void place_bodice(PatternPanel& panel, bool front, const StyleBody& body);

/// The dimensions of a sleeve beyond the arm's measures [m].
struct SleeveStyle {
    double ease = 0.12;    ///< Girth beyond the upper arm's.
    double length = 0.21;  ///< Underarm to hem.
    double cuff = 0.25;    ///< Width at the hem.
};

/// Returns the left sleeve, whose cap halves are as long as the armhole edges they are sewn to; the deeper the cap, the
/// narrower is the sleeve. y = 0 is the underarm. Edges: `hem`, `back_under`, `back_cap`, `front_cap`, `front_under`.
/// @param front_armhole, back_armhole  arc lengths [m]
PanelDraft draft_sleeve(const SleeveStyle& style, double front_armhole, double back_armhole, const StyleBody& body);

/// Armholes of a garment, {left, right}, named as `front.left_armhole`.
struct Armholes {
    std::array<std::string, 2> front{"front.left_armhole", "front.right_armhole"};
    std::array<std::string, 2> back{"back.left_armhole", "back.right_armhole"};
};

/// Adds both sleeves to a garment, `left_sleeve` and `right_sleeve`, and places them.
/// @returns how far from the shoulder along the arm their hems start [m]
double add_sleeves(PatternDraft& garment, const SleeveStyle& style, const StyleBody& body,
                   const Armholes& armholes = {});

/// Adds a cuff to each sleeve: a band around the wrist, `left_cuff` and `right_cuff`, sewn to the sleeve's hem.
/// @param girth, height  of the band [m]
/// @param beyond         from the shoulder along the arm to where the cuffs start, unless that is the hand [m]
void add_cuffs(PatternDraft& garment, const StyleBody& body, double girth, double height, double beyond);

/// Adds `front` and `back` of a bodice without openings, placed and sewn at shoulders and sides.
void add_bodice(PatternDraft& garment, const BodiceStyle& style, const StyleBody& body);

/// Sews shoulders and sides of `front` and `back`.
void sew_sides(PatternDraft& garment);

}  // namespace selvage
