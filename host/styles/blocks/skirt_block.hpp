#pragma once
#include "host/styles/blocks/draft.hpp"
#include "host/styles/blocks/style_measures.hpp"

namespace selvage {

/// Height of a waistband [m].
inline constexpr double waistband_height = 0.035;

/// Adds a waistband of a front and a back half around the waist, its lower edge at the waist, and places it. Edges:
/// `waistband_front.bottom_left`, `.bottom_right`, `.left`, `.right`, `.top` and the same of `waistband_back`, sewn
/// together at the sides; sides are those of the wearer.
/// @param girth  of the band [m]
void add_waistband(PatternDraft& garment, const StyleBody& body, double girth);

}  // namespace selvage
