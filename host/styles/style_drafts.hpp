#pragma once
#include "host/styles/blocks/style_measures.hpp"
#include "io/pattern/pattern.hpp"

namespace selvage {

/// Drafts one style from the measures of a body and places its panels around that body, in the body's own frame. Every
/// panel's outside faces away from the body; its warp (y) runs upwards, or up the limb.
using DraftStyle = Pattern(const StyleBody& body);

DraftStyle draft_tshirt, draft_vest, draft_shirt, draft_hoody, draft_dress, draft_trousers, draft_gathered_skirt,
    draft_circle_skirt;

}  // namespace selvage
