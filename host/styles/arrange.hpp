#pragma once
#include <map>
#include <string>

#include "host/styles/blocks/style_measures.hpp"
#include "io/pattern/pattern.hpp"

namespace selvage {

/// True if no panel of a pattern of several has a place of its own: all are moved and turned alike.
bool is_unplaced(const Pattern& pattern);

/// Places the panels of a pattern near the parts of a body that they cover, in the frame of the body's mesh. A name
/// tells part, side and face (see panel_role). Heights follow from the seams: torso panels hang from the shoulders,
/// others from what they are sewn to; without a torso the highest hangs from the waist. Sleeves turn so that the edges
/// that are sewn to the torso point up the arm. Which side of a panel faces outward is what brings its seams nearer.
/// @param parts  panel to a description that is read in place of its name, such as "left sleeve front"
/// @throws InputError for a panel whose name tells no part, and for an unknown panel in `parts`
void arrange(Pattern& pattern, const StyleBody& body, const std::map<std::string, std::string>& parts);

}  // namespace selvage
