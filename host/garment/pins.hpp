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
    std::string list;        ///< Indices from 0 in each panel, separated by commas.
    std::string edges = {};  ///< Edges of its outline by index, from 0 as in the pattern, separated by commas.
};

/// Where the keys of a choice stand, for messages.
struct PinPlaces {
    InputPlace panel, list, edges;
};

/// Returns these vertices, sorted, as indices into the whole cloth.
/// @throws InputError for a panel, an edge or a vertex that does not exist, with the names and the range there are
std::vector<int> chosen_vertices(const Cloth& cloth, const PinChoice& choice, const PinPlaces& places);

/// Sews elastic to edges of a panel of a garment.
/// @throws InputError for a panel or an edge that does not exist, with the names and the range there are
void sew_elastic(Cloth& cloth, const ElasticScene& elastic, const InputPlace& panel_place,
                 const InputPlace& edges_place);

/// Holds vertices of a cloth in place, besides those held already.
void hold_vertices(Cloth& cloth, const std::vector<int>& vertices);

/// Holds vertices of a cloth and moves them after those motions that it has already.
void move_vertices(Cloth& cloth, const std::vector<int>& vertices, const PinMotionScene& motion);

}  // namespace selvage
