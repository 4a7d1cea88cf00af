#pragma once
#include <span>
#include <string>
#include <vector>

#include "host/styles/style_drafts.hpp"

namespace selvage {

/// A garment that is drafted from the measures of a body.
struct Style {
    const char* name;     ///< As in `builtin:NAME`.
    const char* summary;  ///< One sentence.
    DraftStyle* draft;
};

/// Returns the catalogue.
std::span<const Style> styles();

/// Returns the names of all styles.
std::vector<std::string> style_names();

/// Returns a style by its name.
/// @param key  that names the style, for messages
/// @throws InputError for an unknown name
const Style& find_style(const std::string& name, const std::string& key);

/// Drafts a style for a body and places it around it, in the frame of the body's mesh [m]. Every panel's outside faces
/// away from the body; its warp (y) runs upwards, or up the limb.
/// @throws InputError as find_style()
Pattern draft_style(const std::string& name, const StyleBody& body, const std::string& key = "garment.pattern");

}  // namespace selvage
