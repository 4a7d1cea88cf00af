#pragma once
#include <string>

#include "host/model/cloth.hpp"
#include "io/errors.hpp"
#include "io/scene/scene_tables.hpp"

namespace selvage {

/// Some vertices of a cloth that a scene names.
struct PinChoice {
    std::string panel;  ///< Name of a panel; empty: every sheet, that is every panel that is no part of a garment.
    PinGroup group = PinGroup::none;
    std::string list;  ///< Indices from 0 in each panel, separated by commas.
};

/// Returns these vertices, sorted, as indices into the whole cloth.
/// @param panel_place, list_place  of the keys, for messages
/// @throws InputError for a panel or a vertex that does not exist, with the names and the range there are
std::vector<int> chosen_vertices(const Cloth& cloth, const PinChoice& choice, const InputPlace& panel_place,
                                 const InputPlace& list_place);

/// Holds vertices of a cloth in place, besides those held already.
void hold_vertices(Cloth& cloth, const std::vector<int>& vertices);

/// Holds vertices of a cloth and moves them after those motions that it has already.
void move_vertices(Cloth& cloth, const std::vector<int>& vertices, const PinMotionScene& motion);

}  // namespace selvage
