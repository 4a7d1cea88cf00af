#pragma once
#include <array>
#include <string>

#include "host/styles/blocks/draft.hpp"
#include "host/styles/blocks/style_measures.hpp"

namespace selvage {

/// Edges of a garment's neckline, {left, right}.
using NeckEdges = std::array<std::string, 2>;

/// Adds a flat collar of `left_collar`, `right_collar` and `collar_back`, which lies on the shoulders, open in the
/// middle of the front, and starts outside the bodice.
/// @param front, back        halves from draft_half_bodice(), whose necklines it follows
/// @param front_place, back_place  panels that are placed as the collar is to lie
/// @param width              in the middle of the back and at the shoulder [m]
/// @param point              by how much it is wider at its ends [m]
void add_flat_collar(PatternDraft& garment, const PanelDraft& front, const PanelDraft& back,
                     const PatternPanel& front_place, const PatternPanel& back_place, double width, double point);

/// Adds a hood of two halves, `left_hood` and `right_hood`, sewn over the crown and down the back of the head, as long
/// as the neckline, and places them beside the head.
void add_hood(PatternDraft& garment, const StyleBody& body, const NeckEdges& front, const NeckEdges& back);

}  // namespace selvage
