#pragma once
#include <functional>

#include "host/render/camera.hpp"
#include "host/render/pixel_buffer.hpp"
#include "host/render/scene_tracer.hpp"
#include "host/render/shading.hpp"
#include "io/image.hpp"

namespace selvage {

/// Draws a scene through one camera into a part of a picture, in parallel; the same pixels for any thread count.
/// @param first_column      where the view begins in the picture
/// @param width             of the view [pixels]; it is as high as the picture
/// @param samples_per_axis  square root of the camera rays per pixel
/// @param stop              asked before every pixel, by several threads; true breaks off; may be empty
/// @returns whether the view was drawn to its end
bool draw_view(const PictureScene& scene, const SceneTracer& tracer, const Camera& camera, int samples_per_axis,
               const std::function<bool()>& stop, int first_column, int width, Image& image);

}  // namespace selvage
