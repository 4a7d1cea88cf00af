#pragma once
#include "host/mannequin/mannequin_measures.hpp"
#include "io/errors.hpp"

namespace selvage {

/// Whether a size is one of children, named by their stature in centimetres.
bool is_child_size(BodySize size);

/// Whose table a size is taken from: `figure` unless that is automatic; then children's for their sizes, else women's.
/// @param place  the body or garment in the user's input, for messages
/// @throws InputError for adult figures with sizes of children, and the other way round
BodyFigure figure_of(BodySize size, BodyFigure figure, const InputPlace& place = {"", 0, 0, "body"});

/// Measures of a size, in the A-pose. docs/mannequin.md has the tables and their sources.
/// @throws InputError as figure_of()
MannequinMeasures mannequin_size(BodySize size, BodyFigure figure = BodyFigure::automatic,
                                 const InputPlace& place = {"", 0, 0, "body"});

}  // namespace selvage
