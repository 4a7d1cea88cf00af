#include "host/styles/blocks/placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "host/garment/assemble.hpp"
#include "host/garment/outline.hpp"

namespace selvage {
namespace {

constexpr double row_height = 0.005;  // of the table of a panel's widths [m]
constexpr int bends = 24;             // that are tried for a panel that cannot go half around
constexpr double ends_apart = 0.004;  // of two panels that go half around, at least [m]

/// Columns: the panel's x, y and outward normal.
Mat3 panel_rotation(const Vec3& up, const Vec3& outward)
{
    Mat3 rotation;
    rotation << up.cross(outward), up, outward;
    return rotation;
}

/// The widths of a panel by height, grown by a margin.
class Extent {
public:
    Extent(const PatternPanel& panel, double middle, double margin)
    {
        std::vector<Vec2> outline = sample_outline(panel, std::vector<int>(panel.edges.size(), 32));
        for (Vec2& p : outline) p.x() -= middle;
        for (const Vec2& p : outline) {
            low_ = std::min(low_, p.y() - margin);
            high_ = std::max(high_, p.y() + margin);
            half_width = std::max(half_width, std::abs(p.x()));
        }
        rows_.resize(std::size_t((high_ - low_) / row_height) + 1);
        for (std::size_t k = 0; k < outline.size(); ++k) fill(outline[k], outline[(k + 1) % outline.size()], margin);
    }

    bool covers(double x, double y) const
    {
        if (y < low_ || y > high_) return false;
        const Row& row = rows_[std::size_t((y - low_) / row_height)];
        return x >= row.left && x <= row.right;
    }

    bool reaches(double y) const { return y >= low_ && y <= high_; }

    double half_width = 0;  ///< Of the whole panel [m].

private:
    struct Row {
        double left = std::numeric_limits<double>::infinity(), right = -std::numeric_limits<double>::infinity();
    };

    void fill(const Vec2& a, const Vec2& b, double margin)
    {
        const int steps = int(std::abs(b.y() - a.y()) / row_height) + 1;
        for (int k = 0; k <= steps; ++k) {
            const Vec2 p = a + double(k) / steps * (b - a);
            const auto from = std::size_t(std::max(0.0, (p.y() - margin - low_) / row_height));
            const auto to = std::min(rows_.size() - 1, std::size_t((p.y() + margin - low_) / row_height));
            for (std::size_t row = from; row <= to; ++row) {
                rows_[row].left = std::min(rows_[row].left, p.x() - margin);
                rows_[row].right = std::max(rows_[row].right, p.x() + margin);
            }
        }
    }

    double low_ = 1e9, high_ = -1e9;
    std::vector<Row> rows_;
};

/// Returns how far from the axis the middle of a panel has to be, so that a bend of this radius clears the points.
/// @param points  {across, outward, up}, up from the panel's y = 0 [m]
double distance_to_clear(const std::vector<Vec3>& points, const Extent& extent, double radius, double gap)
{
    double distance = -1e9;
    for (const Vec3& p : points) {
        const double sine = std::clamp(p.x() / radius, -1.0, 1.0);
        if (!extent.covers(radius * std::asin(sine), p.z())) continue;
        distance = std::max(distance, p.y() + gap + radius * (1 - std::sqrt(1 - sine * sine)));
    }
    return distance;
}

std::vector<Vec3> seen_from(const std::vector<Vec3>& points, const Vec3& axis, const Mat3& rotation, double height,
                            const Extent& extent)
{
    std::vector<Vec3> seen;
    for (const Vec3& x : points) {
        const Vec3 p = rotation.transpose() * Vec3(x - Vec3(axis.x(), axis.y(), height));
        if (extent.reaches(p.y())) seen.emplace_back(p.x(), p.z(), p.y());
    }
    return seen;
}

void place(PatternPanel& panel, const Vec3& axis, const Vec3& outward, double height, double middle, double distance)
{
    panel.rotation = panel_rotation(Vec3::UnitZ(), outward);
    panel.translation = Vec3(axis.x(), axis.y(), height) + distance * outward - middle * Vec3(panel.rotation.col(0));
}

}  // namespace

void hang_around(PatternPanel& panel, const std::vector<Vec3>& points, const Vec3& axis, const Vec3& outward,
                 double height, double middle, double gap)
{
    const Extent extent(panel, middle, gap);
    const std::vector<Vec3> seen = seen_from(points, axis, panel_rotation(Vec3::UnitZ(), outward), height, extent);
    const double width = extent.half_width, half_around = width / (0.5 * std::numbers::pi);
    double radius = half_around, distance = half_around;
    if (distance_to_clear(seen, extent, half_around, gap) > half_around) {
        double least = std::numeric_limits<double>::infinity();
        for (int k = 0; k < bends; ++k) {
            const double trial = half_around * std::pow(1.12, k);
            const double needed = distance_to_clear(seen, extent, trial, gap);
            const double end = needed - trial * (1 - std::cos(width / trial));
            const double moved = std::max(0.0, ends_apart - end);
            if (std::abs(end + moved) + moved >= least) continue;
            least = std::abs(end + moved) + moved;
            radius = trial;
            distance = needed + moved;
        }
    }
    place(panel, axis, outward, height, middle, distance);
    panel.wrap = PanelWrap{.radius = radius, .x0 = middle, .behind = false};
}

void fold_around(PatternPanel& panel, const std::vector<Vec3>& points, const Vec3& axis, const Vec3& outward, int folds,
                 double most_angle)
{
    PanelWrap wrap = *panel.wrap;
    const Extent extent(panel, wrap.x0, StartGaps::trunk);
    double widest = 0;  // of the body from the axis, on this side
    for (const Vec3& x : points) {
        const Vec3 p = panel.rotation.transpose() * Vec3(x - Vec3(axis.x(), axis.y(), panel.translation.z()));
        if (extent.reaches(p.y()) && p.z() > 0) widest = std::max(widest, std::hypot(p.x(), p.z()));
    }
    wrap.fold = extent.half_width / folds;
    const auto nearest = [&](double angle) {
        wrap.fold_angle = angle;
        const double end = place_on_bend(wrap, wrap.x0 + extent.half_width).y();
        double least = std::numeric_limits<double>::infinity();
        for (int k = 0; k <= 16 * folds; ++k) {
            const Vec2 bent = place_on_bend(wrap, wrap.x0 + extent.half_width * k / (16 * folds));
            least = std::min(least, std::hypot(bent.x(), end - bent.y()));
        }
        return least;
    };
    double angle = most_angle;
    while (angle > 0 && nearest(angle) < widest + StartGaps::trunk) angle -= 0.05;
    if (angle <= 0) return;
    nearest(angle);
    panel.wrap = wrap;
    panel.translation +=
        (place_on_bend(wrap, wrap.x0 + extent.half_width).y() - (panel.translation - axis).dot(outward)) * outward;
}

void hang_flat(PatternPanel& panel, const std::vector<Vec3>& points, const Vec3& axis, const Vec3& outward,
               double height, double middle, double gap)
{
    const Extent extent(panel, middle, gap);
    const double flat = 1e6;  // the radius of a bend that is none [m]
    const std::vector<Vec3> seen = seen_from(points, axis, panel_rotation(Vec3::UnitZ(), outward), height, extent);
    place(panel, axis, outward, height, middle, std::max(gap, distance_to_clear(seen, extent, flat, gap)));
}

void roll_around(PatternPanel& panel, const std::vector<Vec3>& points, const Vec3& start, const Vec3& along,
                 const Vec3& outward, double middle, double gap)
{
    const Extent extent(panel, middle, gap);
    double radius = 1.02 * extent.half_width / std::numbers::pi;
    for (const Vec3& x : points) {
        const double down = (x - start).dot(along);
        if (extent.reaches(-down)) radius = std::max(radius, (x - start - down * along).norm() + gap);
    }
    panel.rotation = panel_rotation(-along, outward);
    panel.translation = start + radius * outward - middle * Vec3(panel.rotation.col(0));
    panel.wrap = PanelWrap{.radius = radius, .x0 = middle, .behind = false};
}

std::vector<Vec3> placed_outlines(const std::vector<PatternPanel>& panels)
{
    std::vector<Vec3> points;
    for (const PatternPanel& panel : panels)
        for (const Vec2& p : sample_outline(panel, std::vector<int>(panel.edges.size(), 24)))
            points.push_back(place_on_panel(panel, p));
    return points;
}

bool tube_holds(const PatternPanel& tube, const std::vector<Vec3>& points, double gap)
{
    const Extent extent(tube, tube.wrap->x0, gap);
    return std::ranges::any_of(points, [&](const Vec3& x) {
        const Vec3 p = tube.rotation.transpose() * (x - tube.translation);
        const Vec2 across(p.x() - tube.wrap->x0, p.z() + tube.wrap->radius);
        return across.norm() < tube.wrap->radius + gap &&
               extent.covers(tube.wrap->radius * std::atan2(across.x(), across.y()), p.y());
    });
}

void place_like(PatternPanel& panel, const PatternPanel& other)
{
    panel.rotation = other.rotation;
    panel.translation = other.translation;
    panel.wrap = other.wrap;
}

void move_to_mesh(Pattern& pattern, const BodyFrame& frame)
{
    const Vec3 origin = frame.to_file(Vec3::Zero());
    Mat3 turn;
    for (int axis = 0; axis < 3; ++axis) turn.col(axis) = frame.to_file(Vec3::Unit(axis)) - origin;
    for (PatternPanel& panel : pattern.panels) {
        panel.translation = frame.to_file(panel.translation);
        panel.rotation = turn * panel.rotation;
    }
}

}  // namespace selvage
