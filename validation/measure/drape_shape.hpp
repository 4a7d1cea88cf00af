#pragma once
#include <vector>

#include "host/model/cloth.hpp"

namespace selvage {

/// The shadow of a draped cloth from above, as a drape meter measures it.
struct DrapeShadow {
    double area = 0;  ///< Area of the union of all faces' projections along z [m^2].
    int folds = 0;    ///< Number of outward bulges of the outline around the origin.
};

/// Measures the shadow by rasterising the projections of all faces.
/// @param cell  side of a square of the raster [m]; the error of the area is a small part of `cell` times the outline
DrapeShadow drape_shadow(const std::vector<Vec3>& positions, const std::vector<Face>& faces, double cell = 2e-4);

}  // namespace selvage
