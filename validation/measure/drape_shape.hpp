#pragma once
#include <vector>

#include "host/model/cloth.hpp"

namespace selvage {

/// What a drape meter sees of a draped cloth from above.
struct DrapeShadow {
    double area = 0;  ///< Of the union of all faces' projections along z [m^2].
    int folds = 0;    ///< How often its outline bulges out, counted around the origin.
};

/// Rasterises the projections of all faces.
/// @param cell  side of a square of the raster [m]; the area is good to a small part of the outline's length times it
DrapeShadow drape_shadow(const std::vector<Vec3>& positions, const std::vector<Face>& faces, double cell = 2e-4);

}  // namespace selvage
