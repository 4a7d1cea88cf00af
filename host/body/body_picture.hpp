#pragma once
#include "host/body/body_measures.hpp"
#include "io/image.hpp"

namespace selvage {

/// Draws a body from its front and from its left side: each part in a colour of its own, the lines of the measures
/// dark, the landmarks as light balls.
/// @param mesh   that was measured
/// @param width  of the picture [pixels]
Image draw_measures(const TriangleMesh& mesh, const BodyMeasures& measures, int width);

}  // namespace selvage
