#include "io/scene/stress_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace selvage {
namespace {

const CurveRange& range_at(const StressCurve& curve, double strain)
{
    std::size_t range = 0;
    while (range + 1 < curve.size() && strain >= curve[range + 1].start) ++range;
    return curve[range];
}

double end_slope(double near_chord, double far_chord, double near_width, double far_width)
{
    const double three_point = near_chord + (near_chord - far_chord) * near_width / (near_width + far_width);
    return std::clamp(three_point, 0.25 * near_chord, 3 * near_chord);
}

// Slopes of the interpolation at all points, the origin among them.
std::vector<double> hermite_slopes(const std::vector<double>& widths, const std::vector<double>& chords)
{
    const std::size_t last = chords.size();
    if (last == 1) return {chords[0], chords[0]};
    std::vector<double> slopes(last + 1);
    for (std::size_t k = 1; k < last; ++k) {
        const double a = 2 * widths[k] + widths[k - 1], b = widths[k] + 2 * widths[k - 1];
        slopes[k] = (a + b) / (a / chords[k - 1] + b / chords[k]);
    }
    slopes[0] = end_slope(chords[0], chords[1], widths[0], widths[1]);
    slopes[last] = end_slope(chords[last - 1], chords[last - 2], widths[last - 1], widths[last - 2]);
    return slopes;
}

std::vector<Vec2> from_origin(const std::vector<Vec2>& points)
{
    std::vector<Vec2> all{Vec2::Zero()};
    all.insert(all.end(), points.begin(), points.end());
    return all;
}

}  // namespace

Vec2 membrane_point(CurveMeasure measure, const Vec2& measured)
{
    const double x = measured.x();
    if (measure == CurveMeasure::shear) return {std::sin(x), measured.y()};
    return {x + 0.5 * x * x, measured.y() / (1 + x)};
}

Vec2 measured_point(CurveMeasure measure, const Vec2& point)
{
    if (measure == CurveMeasure::shear) return {std::asin(std::min(point.x(), 1.0)), point.y()};
    const double stretch = std::sqrt(1 + 2 * point.x());
    return {stretch - 1, point.y() * stretch};
}

StressCurve straight_curve(double slope) { return {{0, 0, slope, 0, 0}}; }

StressCurve piecewise_curve(const std::vector<Vec2>& points)
{
    const std::vector<Vec2> all = from_origin(points);
    StressCurve curve;
    for (std::size_t k = 0; k + 1 < all.size(); ++k) {
        const Vec2 step = all[k + 1] - all[k];
        curve.push_back({all[k].x(), all[k].y(), step.y() / step.x(), 0, 0});
    }
    return curve;
}

StressCurve smooth_curve(const std::vector<Vec2>& points)
{
    const std::vector<Vec2> all = from_origin(points);
    std::vector<double> widths, chords;
    for (std::size_t k = 0; k + 1 < all.size(); ++k) {
        widths.push_back(all[k + 1].x() - all[k].x());
        chords.push_back((all[k + 1].y() - all[k].y()) / widths.back());
    }
    const std::vector<double> slopes = hermite_slopes(widths, chords);
    StressCurve curve;
    for (std::size_t k = 0; k < chords.size(); ++k)
        curve.push_back({all[k].x(), all[k].y(), slopes[k], (3 * chords[k] - 2 * slopes[k] - slopes[k + 1]) / widths[k],
                         (slopes[k] + slopes[k + 1] - 2 * chords[k]) / (widths[k] * widths[k])});
    curve.push_back({all.back().x(), all.back().y(), slopes.back(), 0, 0});
    return curve;
}

StressCurve cubic_curve(double k1, double k2, double k3) { return {{0, 0, k1, k2, k3}}; }

StressCurve limited_curve(const StressCurve& curve, double limit, double factor)
{
    StressCurve limited;
    for (const CurveRange& range : curve)
        if (range.start < limit) limited.push_back(range);
    limited.push_back({limit, curve_stress(curve, limit), factor * curve_slope(curve, limit), 0, 0});
    return limited;
}

double curve_stress(const StressCurve& curve, double strain)
{
    const CurveRange& r = range_at(curve, strain);
    const double d = strain - r.start;
    return r.stress + d * (r.slope + d * (r.quadratic + d * r.cubic));
}

double curve_slope(const StressCurve& curve, double strain)
{
    const CurveRange& r = range_at(curve, strain);
    const double d = strain - r.start;
    return r.slope + d * (2 * r.quadratic + 3 * d * r.cubic);
}

double smallest_slope(const StressCurve& curve)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double least = infinity;
    for (std::size_t k = 0; k < curve.size(); ++k) {
        const CurveRange& r = curve[k];
        const bool ends = k + 1 < curve.size();
        if (!ends && (r.cubic < 0 || (r.cubic == 0 && r.quadratic < 0))) return -infinity;
        const double width = ends ? curve[k + 1].start - r.start : infinity;
        const auto slope_at = [&](double d) { return r.slope + d * (2 * r.quadratic + 3 * d * r.cubic); };
        least = std::min(least, r.slope);
        if (ends) least = std::min(least, slope_at(width));
        const double turn = r.cubic == 0 ? -1 : -r.quadratic / (3 * r.cubic);
        if (turn > 0 && turn < width) least = std::min(least, slope_at(turn));
    }
    return least;
}

std::vector<double> start_energies(const StressCurve& curve)
{
    std::vector<double> energies{0};
    for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
        const CurveRange& r = curve[k];
        const double d = curve[k + 1].start - r.start;
        energies.push_back(energies.back() +
                           d * (r.stress + d * (r.slope / 2 + d * (r.quadratic / 3 + d * r.cubic / 4))));
    }
    return energies;
}

}  // namespace selvage
