#pragma once
#include <string>
#include <vector>

#include "host/styles/blocks/draft.hpp"
#include "host/styles/blocks/style_measures.hpp"

namespace selvage {

/// Height of a waistband [m].
inline constexpr double waistband_height = 0.035;

/// A dart in a waistline.
struct Dart {
    double at = 0.5;      ///< Share of the sewn length between the middle of the body and the dart.
    double width = 0.02;  ///< At the waistline [m].
    double depth = 0.10;  ///< [m]
};

/// Adds a straight waistline with a dart from the last corner to `end`. Its two parts are the edges `waist_0`, at the
/// middle of the body, and `waist_1`; the sides of the dart are `dart_0` and `dart_1`.
/// @param to_middle  the line runs towards the middle of the body
void add_waistline(PanelDraft& draft, const Vec2& end, const Dart& dart, bool to_middle);

/// Adds a waistband of a front and a back half around the waist, its lower edge at the waist, and places it. Edges:
/// `waistband_front.left_0` and `.left_1`, the lower edge from the middle of the body to a dart and on to the side, the
/// same with `right`, `.left_end`, `.right_end`, `.top`, and the same of `waistband_back`, sewn together at the sides;
/// sides are those of the wearer.
/// @param girth  of the band [m]
/// @param front, back  where the lower edges are divided, as Dart::at; 1: nowhere, `left_1` and `right_1` are left out
void add_waistband(PatternDraft& garment, const StyleBody& body, double girth, double front, double back);

/// Returns the points of a body that a garment below the waist may meet.
std::vector<Vec3> below_waist(const StyleBody& body);

}  // namespace selvage
