#include "bench/harness/chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace selvage {
namespace {

constexpr int margin_left = 84, margin_top = 44, margin_bottom = 62, legend_width = 250;
const cv::Scalar ink(40, 40, 40), faint(225, 225, 225), fainter(242, 242, 242), white(255, 255, 255);

// Okabe and Ito 2008; colour-blind readers can tell these colours apart as well.
const std::array<cv::Scalar, 8> palette = {cv::Scalar(0, 114, 178),   cv::Scalar(213, 94, 0),  cv::Scalar(0, 158, 115),
                                           cv::Scalar(204, 121, 167), cv::Scalar(20, 20, 20),  cv::Scalar(230, 159, 0),
                                           cv::Scalar(86, 180, 233),  cv::Scalar(150, 120, 60)};

cv::Mat canvas(int width, int height) { return cv::Mat(height, width, CV_8UC3, white); }

Image image_of(const cv::Mat& picture)
{
    Image image = make_image(picture.cols, picture.rows);
    for (int row = 0; row < picture.rows; ++row)
        for (int column = 0; column < picture.cols; ++column) {
            const cv::Vec3b& p = picture.at<cv::Vec3b>(row, column);
            image.at(column, row) = {p[0], p[1], p[2]};
        }
    return image;
}

cv::Size text_size(const std::string& text, double scale)
{
    int baseline = 0;
    return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale, 1, &baseline);
}

void write_text(cv::Mat& on, const std::string& text, cv::Point left_base, double scale)
{
    cv::putText(on, text, left_base, cv::FONT_HERSHEY_SIMPLEX, scale, ink, 1, cv::LINE_AA);
}

void write_centred(cv::Mat& on, const std::string& text, cv::Point middle, double scale)
{
    const cv::Size size = text_size(text, scale);
    write_text(on, text, {middle.x - size.width / 2, middle.y + size.height / 2}, scale);
}

// Writes text that runs upwards, with its middle at the given point.
void write_upright(cv::Mat& on, const std::string& text, cv::Point middle, double scale)
{
    const cv::Size size = text_size(text, scale);
    cv::Mat label = canvas(size.width + 4, size.height + 10), turned;
    write_text(label, text, {2, size.height + 3}, scale);
    cv::rotate(label, turned, cv::ROTATE_90_COUNTERCLOCKWISE);
    cv::Rect place(middle.x - turned.cols / 2, middle.y - turned.rows / 2, turned.cols, turned.rows);
    place &= cv::Rect(0, 0, on.cols, on.rows);
    turned(cv::Rect(0, 0, place.width, place.height)).copyTo(on(place));
}

// The shortest span of an axis [decades]. Labels stand at 1, 2 and 5 times a power of ten, so every second one follows
// within log10(5) = 0.70 decades, and a longer span always shows at least two labels.
constexpr double two_labels = 0.72;

// One logarithmic axis, which maps a value to a pixel.
struct Axis {
    double low = 0, high = 1;  // log10
    int from = 0, to = 1;      // pixels
    int at(double value) const
    {
        return int(std::lround(from + (std::log10(value) - low) / (high - low) * (to - from)));
    }
};

Axis fit_axis(const std::vector<double>& values, int from, int to)
{
    Axis axis{1e300, -1e300, from, to};
    for (double value : values) {
        axis.low = std::min(axis.low, std::log10(value));
        axis.high = std::max(axis.high, std::log10(value));
    }
    if (values.empty()) axis.low = axis.high = 0;
    const double span = axis.high - axis.low;
    const double room = std::max(0.06 * span, 0.5 * (two_labels - span));
    axis.low -= room;
    axis.high += room;
    return axis;
}

// Series beyond the colours take these again, with the next marker.
void draw_marker(cv::Mat& on, cv::Point at, int look, const cv::Scalar& colour)
{
    constexpr int r = 5;
    switch ((look + look / int(palette.size())) % 4) {
        case 0:
            cv::circle(on, at, r, colour, cv::FILLED, cv::LINE_AA);
            break;
        case 1:
            cv::rectangle(on, at - cv::Point(r - 1, r - 1), at + cv::Point(r - 1, r - 1), colour, cv::FILLED);
            break;
        case 2:
            cv::fillConvexPoly(
                on, std::vector<cv::Point>{at + cv::Point(0, -r), at + cv::Point(r, r), at + cv::Point(-r, r)}, colour,
                cv::LINE_AA);
            break;
        default:
            cv::fillConvexPoly(on,
                               std::vector<cv::Point>{at + cv::Point(0, -r - 1), at + cv::Point(r + 1, 0),
                                                      at + cv::Point(0, r + 1), at + cv::Point(-r - 1, 0)},
                               colour, cv::LINE_AA);
    }
}

void draw_grid(cv::Mat& on, const Axis& x, const Axis& y)
{
    for (const Axis* axis : {&x, &y})
        for (int decade = int(std::floor(axis->low)); decade <= int(std::ceil(axis->high)); ++decade)
            for (int digit = 1; digit < 10; ++digit) {
                const double value = digit * std::pow(10.0, decade), place = std::log10(value);
                if (place < axis->low || place > axis->high) continue;
                const int p = axis->at(value);
                const bool upright = axis == &x;
                cv::line(on, upright ? cv::Point(p, y.from) : cv::Point(x.from, p),
                         upright ? cv::Point(p, y.to) : cv::Point(x.to, p), digit == 1 ? faint : fainter);
                // Axes shorter than a decade and a half also get labels at 2 and 5 times a power of ten.
                if (digit != 1 && !(axis->high - axis->low < 1.5 && (digit == 2 || digit == 5))) continue;
                const std::string label =
                    value >= 0.01 && value < 1000 ? fmt::format("{:g}", value) : fmt::format("{:.0e}", value);
                if (upright)
                    write_centred(on, label, {p, y.from + 16}, 0.42);
                else
                    write_text(on, label, {x.from - text_size(label, 0.42).width - 8, p + 4}, 0.42);
            }
    cv::rectangle(on, {x.from, y.to}, {x.to, y.from}, cv::Scalar(150, 150, 150));
}

void draw_guide(cv::Mat& on, const LogChart& chart, const Axis& x, const Axis& y)
{
    if (!(chart.guide_y > 0) || std::log10(chart.guide_y) < y.low || std::log10(chart.guide_y) > y.high) return;
    const int p = y.at(chart.guide_y);
    for (int q = x.from; q < x.to; q += 12) cv::line(on, {q, p}, {std::min(q + 6, x.to), p}, cv::Scalar(120, 120, 120));
    write_text(on, chart.guide_label, {x.to - text_size(chart.guide_label, 0.4).width - 6, p - 5}, 0.4);
}

void draw_series(cv::Mat& on, const ChartSeries& series, int look, const Axis& x, const Axis& y)
{
    const cv::Scalar& colour = palette[std::size_t(look) % palette.size()];
    for (std::size_t i = 0; i < series.x.size(); ++i) {
        const cv::Point at(x.at(series.x[i]), y.at(series.y[i]));
        if (i > 0) cv::line(on, {x.at(series.x[i - 1]), y.at(series.y[i - 1])}, at, colour, 2, cv::LINE_AA);
        draw_marker(on, at, look, colour);
    }
}

cv::Mat mat_of(const Image& image)
{
    cv::Mat picture = canvas(image.width, image.height);
    for (int row = 0; row < image.height; ++row)
        for (int column = 0; column < image.width; ++column) {
            const Rgb& p = image.at(column, row);
            picture.at<cv::Vec3b>(row, column) = {p[0], p[1], p[2]};
        }
    return picture;
}

}  // namespace

Image draw_log_chart(const LogChart& chart, const std::vector<std::string>& names, int width, int height)
{
    cv::Mat picture = canvas(width, height);
    std::vector<double> xs, ys;
    for (const ChartSeries& series : chart.series) {
        xs.insert(xs.end(), series.x.begin(), series.x.end());
        ys.insert(ys.end(), series.y.begin(), series.y.end());
    }
    const int right = width - legend_width, bottom = height - margin_bottom;
    const Axis x = fit_axis(xs, margin_left, right), y = fit_axis(ys, bottom, margin_top);
    draw_grid(picture, x, y);
    draw_guide(picture, chart, x, y);
    int line = margin_top + 10;
    for (const ChartSeries& series : chart.series) {
        const int look = int(std::find(names.begin(), names.end(), series.name) - names.begin());
        draw_series(picture, series, look, x, y);
        cv::line(picture, {right + 14, line}, {right + 40, line}, palette[std::size_t(look) % palette.size()], 2,
                 cv::LINE_AA);
        draw_marker(picture, {right + 27, line}, look, palette[std::size_t(look) % palette.size()]);
        write_text(picture, series.name, {right + 48, line + 5}, 0.43);
        line += 22;
    }
    write_text(picture, chart.title, {margin_left, 28}, 0.6);
    write_centred(picture, chart.x_label, {(x.from + x.to) / 2, height - 22}, 0.48);
    write_upright(picture, chart.y_label, {18, (y.from + y.to) / 2}, 0.48);
    return image_of(picture);
}

std::string power_label(double value)
{
    const int power = int(std::floor(std::log10(value) + 1e-9));
    return fmt::format("{:.0f}e{}", value / std::pow(10.0, power), power);
}

Image draw_cell_map(const CellMap& map, const std::vector<CellKind>& kinds, int width, int height)
{
    cv::Mat picture = canvas(width, height);
    const int columns = int(map.columns.size()), rows = int(map.rows.size());
    const int left = 160, top = 40, right = width - 12, bottom = height - 52;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const Rgb& c = kinds[std::size_t(map.kind[std::size_t(row * columns + column)])].colour;
            const cv::Point from(left + (right - left) * column / columns, top + (bottom - top) * row / rows);
            const cv::Point to(left + (right - left) * (column + 1) / columns - 2,
                               top + (bottom - top) * (row + 1) / rows - 2);
            cv::rectangle(picture, from, to, cv::Scalar(c[0], c[1], c[2]), cv::FILLED);
        }
    for (int column = 0; column < columns; ++column)
        write_centred(picture, map.columns[std::size_t(column)],
                      {left + (right - left) * (2 * column + 1) / (2 * columns), bottom + 12}, 0.38);
    for (int row = 0; row < rows; ++row) {
        const std::string& label = map.rows[std::size_t(row)];
        write_text(picture, label,
                   {left - text_size(label, 0.38).width - 6, top + (bottom - top) * (2 * row + 1) / (2 * rows) + 4},
                   0.38);
    }
    write_text(picture, map.title, {left, 26}, 0.52);
    write_centred(picture, map.column_label, {(left + right) / 2, height - 20}, 0.44);
    write_upright(picture, map.row_label, {14, (top + bottom) / 2}, 0.44);
    return image_of(picture);
}

Image draw_cell_legend(const std::vector<CellKind>& kinds, int width)
{
    constexpr double size = 0.9;
    cv::Mat picture = canvas(width, 64);
    int at = 30;
    for (const CellKind& kind : kinds) {
        cv::rectangle(picture, {at, 16}, {at + 30, 46}, cv::Scalar(kind.colour[0], kind.colour[1], kind.colour[2]),
                      cv::FILLED);
        write_text(picture, kind.name, {at + 42, 40}, size);
        at += 42 + text_size(kind.name, size).width + 50;
    }
    return image_of(picture);
}

Image captioned(const Image& picture, const std::string& text, int width, int height)
{
    cv::Mat field = canvas(width, height);
    const int room = height - 26;
    if (picture.width > 0) {
        const double scale = std::min(double(width) / picture.width, double(room) / picture.height);
        cv::Mat small;
        cv::resize(mat_of(picture), small, {}, scale, scale, cv::INTER_AREA);
        small.copyTo(field(cv::Rect((width - small.cols) / 2, 0, small.cols, small.rows)));
    }
    write_centred(field, text, {width / 2, height - 12}, 0.4);
    return image_of(field);
}

Image tile(const std::vector<Image>& pictures, int columns)
{
    if (pictures.empty()) return {};
    const int width = pictures.front().width, height = pictures.front().height;
    const int rows = (int(pictures.size()) + columns - 1) / columns;
    cv::Mat all = canvas(width * columns, height * rows);
    for (int i = 0; i < int(pictures.size()); ++i)
        mat_of(pictures[std::size_t(i)])
            .copyTo(all(cv::Rect(i % columns * width, i / columns * height, width, height)));
    return image_of(all);
}

Image stack(const Image& above, const Image& below)
{
    cv::Mat all = canvas(std::max(above.width, below.width), above.height + below.height);
    mat_of(above).copyTo(all(cv::Rect(0, 0, above.width, above.height)));
    mat_of(below).copyTo(all(cv::Rect(0, above.height, below.width, below.height)));
    return image_of(all);
}

}  // namespace selvage
