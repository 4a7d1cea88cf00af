#include "io/image.hpp"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <opencv2/imgcodecs.hpp>

#include "io/atomic_file.hpp"
#include "io/errors.hpp"

namespace selvage {

namespace {

// A terminal's pipe or a device is written as it is: nothing can take its place.
void write_stream(const std::string& path, std::string_view bytes)
{
    errno = 0;
    std::ofstream stream(path, std::ios::binary);
    stream.write(bytes.data(), std::streamsize(bytes.size()));
    stream.close();
    if (!stream) throw WriteError(path, errno);
}

}  // namespace

Image make_image(int width, int height, Rgb colour)
{
    Image image{width, height, {}};
    image.pixels.assign(std::size_t(width) * std::size_t(height), colour);
    return image;
}

Image read_image(const std::string& file)
{
    const cv::Mat bgr = cv::imread(file, cv::IMREAD_COLOR);
    if (bgr.empty()) throw InputError({file, 0, 0, {}}, "no picture", "a picture, such as a PNG file");
    Image image = make_image(bgr.cols, bgr.rows);
    for (int row = 0; row < bgr.rows; ++row)
        for (int column = 0; column < bgr.cols; ++column) {
            const cv::Vec3b& pixel = bgr.at<cv::Vec3b>(row, column);
            image.at(column, row) = {pixel[2], pixel[1], pixel[0]};
        }
    return image;
}

void write_png(const std::string& file, const Image& image)
{
    const std::size_t pixel_count = std::size_t(image.width) * std::size_t(image.height);
    if (pixel_count == 0 || image.pixels.size() != pixel_count)
        throw InputError({file, 0, 0, {}},
                         std::to_string(image.pixels.size()) + " pixels for " + std::to_string(image.width) + " x " +
                             std::to_string(image.height),
                         "a picture of at least one pixel");

    cv::Mat bgr(image.height, image.width, CV_8UC3);
    for (int row = 0; row < image.height; ++row)
        for (int column = 0; column < image.width; ++column) {
            const Rgb& rgb = image.at(column, row);
            bgr.at<cv::Vec3b>(row, column) = {rgb[2], rgb[1], rgb[0]};
        }
    // The picture is encoded in memory, so that the file's name need not end in ".png".
    std::vector<std::uint8_t> bytes;
    cv::imencode(".png", bgr, bytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::error_code none;
    const bool is_stream = std::filesystem::exists(file, none) && !std::filesystem::is_regular_file(file, none);
    is_stream ? write_stream(file, text) : write_file_atomically(file, text);
}

}  // namespace selvage
