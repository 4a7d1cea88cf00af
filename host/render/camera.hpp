#pragma once
#include <span>

#include "host/render/drawn_mesh.hpp"

namespace selvage {

/// Where a view looks from: around the z axis and above the horizon.
struct ViewDirection {
    float azimuth = 0;    ///< [rad]; 0 looks from -y towards +y (the front), pi / 2 from +x, pi from behind.
    float elevation = 0;  ///< [rad] above the horizon.
};

/// The two views that stand side by side.
enum class PictureViews {
    automatic,       ///< Front and back for cloth with seams, three quarters for sheets.
    front_and_back,  ///< From -y and from +y, a little from above.
    front_and_side,  ///< From -y and from +x, level.
    three_quarters,  ///< From the front right and the back left, from above.
};

/// A perspective camera; screen coordinates run from -1 to 1, right and up.
struct Camera {
    Vec3f origin = Vec3f::Zero();  ///< [m]
    Vec3f right = Vec3f::UnitX(), up = Vec3f::UnitZ(), forward = Vec3f::UnitY();
    float half_width = 0.1f, half_height = 0.1f;  ///< Tangents of half the field of view.
    float subject_depth = 1;                      ///< Distance at which the subject stands [m].

    /// Returns the unit direction through a point of the screen.
    Vec3f direction(float x, float y) const
    {
        return (forward + x * half_width * right + y * half_height * up).normalized();
    }
    /// Returns the size of a pixel on the subject [m].
    float pixel_size(int pixels_across) const { return 2 * half_width * subject_depth / float(pixels_across); }
};

/// Returns height / width of the points' outline as seen from afar.
float outline_aspect(std::span<const Vec3f> points, ViewDirection direction);

/// Places a camera with a long lens so that all points just fit, with a margin.
/// @param aspect  height / width of the picture
/// @param margin  fraction of the picture's size kept free on each side
Camera frame_points(std::span<const Vec3f> points, ViewDirection direction, float aspect, float margin);

}  // namespace selvage
