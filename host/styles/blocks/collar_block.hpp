#pragma once
#include <array>
#include <string>

#include "host/styles/blocks/draft.hpp"
#include "host/styles/blocks/style_measures.hpp"

namespace selvage {

/// Edges of a garment's neckline, {left, right}.
using NeckEdges = std::array<std::string, 2>;

/// The dimensions of a shirt collar [m].
struct CollarStyle {
    double stand = 0.030;  ///< Height of the stand.
    double fall = 0.045;   ///< Height of the fall in the middle of the back.
    double point = 0.020;  ///< By how much the fall is higher at its ends.
};

/// Adds a shirt collar, buttoned: `collar_stand` around the neck, as long as the neckline, and `collar` that falls over
/// it, and places them, the fall turned down.
void add_collar(PatternDraft& garment, const StyleBody& body, const NeckEdges& front, const NeckEdges& back,
                const CollarStyle& style);

/// Adds a hood of two halves, `left_hood` and `right_hood`, sewn over the crown and down the back of the head, as long
/// as the neckline, and places them beside the head.
void add_hood(PatternDraft& garment, const StyleBody& body, const NeckEdges& front, const NeckEdges& back);

}  // namespace selvage
