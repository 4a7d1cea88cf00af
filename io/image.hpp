#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace selvage {

using Rgb = std::array<std::uint8_t, 3>;

/// An 8-bit sRGB picture, row by row from the top left.
struct Image {
    int width = 0, height = 0;
    std::vector<Rgb> pixels;  ///< width * height.

    Rgb& at(int column, int row) { return pixels[std::size_t(row) * std::size_t(width) + std::size_t(column)]; }
    const Rgb& at(int column, int row) const
    {
        return pixels[std::size_t(row) * std::size_t(width) + std::size_t(column)];
    }
};

/// Returns a picture of one colour.
Image make_image(int width, int height, Rgb colour = {0, 0, 0});

/// Reads a picture of any kind that OpenCV knows, as 8-bit colours.
/// @throws InputError if the file cannot be read as a picture
Image read_image(const std::string& file);

/// Writes a picture as PNG.
/// @throws InputError if the picture is empty or the file cannot be written.
void write_png(const std::string& file, const Image& image);

}  // namespace selvage
