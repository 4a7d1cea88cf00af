#pragma once
#include <vector>

#include "host/render/drawn_mesh.hpp"

namespace selvage {

/// What one pixel of a view shows, before its noise is removed.
struct Pixel {
    static constexpr int backdrop = -2, ground = -1, mixed = -3;

    int subject = backdrop;             ///< Mesh index, ground or backdrop; mixed across an outline or sharp fold.
    Vec3f colour = Vec3f::Zero();       ///< Linear; mean of reflectance times light.
    Vec3f reflectance = Vec3f::Zero();  ///< Mean; free of noise.
    Vec3f light = Vec3f::Zero();        ///< Mean; noisy.
    Vec3f normal = Vec3f::Zero();       ///< Of the surface in the middle of the pixel.
    Vec3f position = Vec3f::Zero();     ///< [m]
};

/// The pixels of one view, row by row from the top left.
struct PixelBuffer {
    int width = 0, height = 0;
    std::vector<Pixel> pixels;

    PixelBuffer(int columns, int rows) : width(columns), height(rows), pixels(std::size_t(columns) * std::size_t(rows))
    {
    }
    Pixel& at(int column, int row) { return pixels[std::size_t(row) * std::size_t(width) + std::size_t(column)]; }
    const Pixel& at(int column, int row) const
    {
        return pixels[std::size_t(row) * std::size_t(width) + std::size_t(column)];
    }
};

/// Returns a pixel's linear colour. Its light is averaged over those pixels of the interleaved block around it that
/// show the same piece of surface. Its reflectance is not, so that seams stay sharp.
/// @param pixel_size  of the subject, for telling neighbouring layers apart [m]
Vec3f smoothed_colour(const PixelBuffer& buffer, int column, int row, float pixel_size);

}  // namespace selvage
