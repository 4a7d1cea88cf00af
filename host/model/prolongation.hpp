#pragma once
#include "host/model/cloth.hpp"

namespace selvage {

/// Returns the linear interpolation from a coarse cloth to a fine one of the same pattern or sheet.
/// A vertex on an outline edge takes the two samples of the same edge around its arc-length fraction, so that
/// both sides of a seam get the same weights. Any other vertex takes the corners of the triangle that holds
/// its panel coordinates, or the nearest point of the nearest triangle where it lies outside all of them.
/// @throws std::invalid_argument if the panels or outline edges of the two cloths do not correspond
Prolongation make_prolongation(const Cloth& coarse, const Cloth& fine);

}  // namespace selvage
