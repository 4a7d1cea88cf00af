#include "host/render/pixel_buffer.hpp"

#include <algorithm>
#include <cmath>

#include "host/render/sampling.hpp"

namespace selvage {
namespace {

// Limits within which two pixels show the same piece of surface. Chosen by eye.
constexpr float same_piece_cosine = 0.93f;  // between their normals
constexpr float same_piece_offset = 3;      // distance of one from the tangent plane of the other [pixels]

bool show_same_piece(const Pixel& a, const Pixel& b, float pixel_size)
{
    return a.subject == b.subject && a.normal.dot(b.normal) > same_piece_cosine &&
           std::abs(a.normal.dot(b.position - a.position)) < same_piece_offset * pixel_size;
}

}  // namespace

Vec3f smoothed_colour(const PixelBuffer& buffer, int column, int row, float pixel_size)
{
    const Pixel& pixel = buffer.at(column, row);
    if (pixel.subject == Pixel::mixed || pixel.subject == Pixel::backdrop) return pixel.colour;

    // The window is one pixel wider than the block, with half the weight at its edges. It is therefore centred, and
    // every phase of the samples has the same weight.
    constexpr int half = InterleavedSamples::block / 2;
    Vec3f light = Vec3f::Zero();
    float total = 0;
    for (int y = std::max(0, row - half); y <= std::min(buffer.height - 1, row + half); ++y)
        for (int x = std::max(0, column - half); x <= std::min(buffer.width - 1, column + half); ++x) {
            const Pixel& other = buffer.at(x, y);
            if (!show_same_piece(pixel, other, pixel_size)) continue;
            const float weight = (std::abs(x - column) == half ? 0.5f : 1.f) * (std::abs(y - row) == half ? 0.5f : 1.f);
            light += weight * other.light;
            total += weight;
        }
    return pixel.reflectance.cwiseProduct(light / total);
}

}  // namespace selvage
