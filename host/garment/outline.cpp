#include "host/garment/outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/mesh/delaunay.hpp"
#include "io/errors.hpp"

namespace selvage {
namespace {

constexpr int bezier_intervals = 64;    // of one quadrature each, for a relative error of the length below 1e-6
constexpr int check_segments = 48;      // of a curved edge, in the search for crossings, at any resolution of the mesh
constexpr double shortest_edge = 1e-6;  // [m]

}  // namespace

EdgePath::EdgePath(const PatternPanel& panel, const PatternEdge& edge)
    : curve_(edge.curve), start_(panel.vertices[edge.start]), end_(panel.vertices[edge.end])
{
    const Vec2& first = edge.control[0];
    switch (curve_) {
        case EdgeCurve::straight:
            length_ = (end_ - start_).norm();
            break;
        case EdgeCurve::arc:
            set_arc(edge);
            break;
        case EdgeCurve::quadratic:
            points_ = {start_, start_ + 2.0 / 3 * (first - start_), end_ + 2.0 / 3 * (first - end_), end_};
            measure_bezier();
            break;
        case EdgeCurve::cubic:
            points_ = {start_, first, edge.control[1], end_};
            measure_bezier();
            break;
    }
}

// Source: SVG 2 (2018), appendix B.2.4, for a circle. `right` is the sweep flag: angles grow along the edge.
void EdgePath::set_arc(const PatternEdge& edge)
{
    const Vec2 chord = end_ - start_;
    const double half_chord = 0.5 * chord.norm();
    radius_enlarged_ = edge.radius < half_chord * (1 - 1e-9);
    radius_ = std::max(edge.radius, half_chord);
    const double height = std::sqrt(std::max(0.0, radius_ * radius_ - half_chord * half_chord));
    const Vec2 left = Vec2(-chord.y(), chord.x()).normalized();
    centre_ = 0.5 * (start_ + end_) + (edge.large_arc == edge.right ? -height : height) * left;
    const Vec2 from = start_ - centre_, to = end_ - centre_;
    first_angle_ = std::atan2(from.y(), from.x());
    swept_angle_ = std::atan2(to.y(), to.x()) - first_angle_;
    constexpr double turn = 2 * std::numbers::pi;
    if (edge.right && swept_angle_ < 0) swept_angle_ += turn;
    if (!edge.right && swept_angle_ > 0) swept_angle_ -= turn;
    length_ = radius_ * std::abs(swept_angle_);
}

Vec2 EdgePath::bezier(double t) const
{
    const double s = 1 - t;
    return s * s * s * points_[0] + 3 * s * s * t * points_[1] + 3 * s * t * t * points_[2] + t * t * t * points_[3];
}

double EdgePath::bezier_speed(double t) const
{
    const double s = 1 - t;
    return 3 * (s * s * (points_[1] - points_[0]) + 2 * s * t * (points_[2] - points_[1]) +
                t * t * (points_[3] - points_[2]))
                   .norm();
}

// Gauss-Legendre quadrature with five points.
double EdgePath::bezier_length(double from, double to) const
{
    constexpr double place[] = {0, 0.5384693101056831, 0.9061798459386640};
    constexpr double weight[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    double sum = weight[0] * bezier_speed(middle);
    for (int i = 1; i < 3; ++i)
        sum += weight[i] * (bezier_speed(middle - half * place[i]) + bezier_speed(middle + half * place[i]));
    return half * sum;
}

void EdgePath::measure_bezier()
{
    length_before_.assign(1, 0.0);
    for (int i = 0; i < bezier_intervals; ++i)
        length_before_.push_back(length_before_.back() +
                                 bezier_length(double(i) / bezier_intervals, double(i + 1) / bezier_intervals));
    length_ = length_before_.back();
}

Vec2 EdgePath::at(double fraction) const
{
    if (fraction <= 0) return start_;
    if (fraction >= 1) return end_;
    if (curve_ == EdgeCurve::straight) return start_ + fraction * (end_ - start_);
    if (curve_ == EdgeCurve::arc) {
        const double angle = first_angle_ + fraction * swept_angle_;
        return centre_ + radius_ * Vec2(std::cos(angle), std::sin(angle));
    }
    const double wanted = fraction * length_;
    const auto above = std::upper_bound(length_before_.begin(), length_before_.end() - 1, wanted);
    const int interval = std::max(0, int(above - length_before_.begin()) - 1);
    const double from = double(interval) / bezier_intervals;
    double low = from, high = from + 1.0 / bezier_intervals, parameter = 0.5 * (low + high);
    // Newton's method, with bisection where the speed along the curve nearly vanishes.
    for (int iteration = 0; iteration < 60 && high - low > 1e-15; ++iteration) {
        const double missing = wanted - length_before_[interval] - bezier_length(from, parameter);
        if (std::abs(missing) < 1e-14 * length_) break;
        (missing > 0 ? low : high) = parameter;
        const double speed = bezier_speed(parameter);
        const double newton = speed > 0 ? parameter + missing / speed : low;
        parameter = newton > low && newton < high ? newton : 0.5 * (low + high);
    }
    return bezier(parameter);
}

std::string edge_key(const PatternPanel& panel, int edge)
{
    return "pattern.panels." + panel.name + ".edges[" + std::to_string(edge) + "]";
}

namespace {

bool lies_on_a_line(const std::vector<Vec2>& points)
{
    const Vec2& origin = points.front();
    const Vec2 farthest = *std::max_element(points.begin(), points.end(), [&](const Vec2& a, const Vec2& b) {
        return (a - origin).squaredNorm() < (b - origin).squaredNorm();
    }) - origin;
    return std::all_of(points.begin(), points.end(), [&](const Vec2& point) {
        const Vec2 arm = point - origin;
        return std::abs(arm.x() * farthest.y() - arm.y() * farthest.x()) <= 1e-7 * farthest.squaredNorm();
    });
}

void check_loop(const Pattern& pattern, const PatternPanel& panel)
{
    const int vertex_count = int(panel.vertices.size()), edge_count = int(panel.edges.size());
    const std::string key = "pattern.panels." + panel.name;
    if (edge_count < 2)
        throw InputError(pattern.place(key + ".edges"), std::to_string(edge_count) + " edges", "at least two");
    for (int vertex = 0; vertex < vertex_count; ++vertex)
        if (!panel.vertices[vertex].allFinite())
            throw InputError(pattern.place(key + ".vertices[" + std::to_string(vertex) + "]"),
                             "a coordinate that is not finite", "two numbers");
    for (int edge = 0; edge < edge_count; ++edge)
        for (const int end : {panel.edges[edge].start, panel.edges[edge].end})
            if (end < 0 || end >= vertex_count)
                throw InputError(pattern.place(edge_key(panel, edge)), "endpoint " + std::to_string(end),
                                 "an index into the panel's " + std::to_string(vertex_count) + " vertices");
    for (int edge = 0; edge < edge_count; ++edge) {
        const int following = (edge + 1) % edge_count, end = panel.edges[edge].end,
                  start = panel.edges[following].start;
        if (end != start)
            throw InputError(
                pattern.place(edge_key(panel, following)),
                "an open outline: a start at vertex " + std::to_string(start),
                "a start at vertex " + std::to_string(end) + ", where edges[" + std::to_string(edge) + "] ends");
    }
}

void check_edge(const Pattern& pattern, const PatternPanel& panel, int index, std::vector<Finding>& findings)
{
    const PatternEdge& edge = panel.edges[index];
    const std::string key = edge_key(panel, index);
    if (edge.start == edge.end || (panel.vertices[edge.start] - panel.vertices[edge.end]).norm() < shortest_edge)
        throw InputError(pattern.place(key), "an edge whose ends coincide", "two ends that are apart");
    if (edge.curve == EdgeCurve::arc && !(edge.radius > 0 && std::isfinite(edge.radius)))
        throw InputError(pattern.place(key), "an arc of radius " + std::to_string(edge.radius) + " m",
                         "a radius above zero");
    const bool bezier = edge.curve == EdgeCurve::quadratic || edge.curve == EdgeCurve::cubic;
    if (bezier && !(edge.control[0].allFinite() && edge.control[1].allFinite()))
        throw InputError(pattern.place(key), "a control point that is not finite", "two numbers");
    const EdgePath path(panel, edge);
    if (path.radius_enlarged())
        findings.push_back({"arc", pattern.place(key),
                            "arc radius " + std::to_string(edge.radius) +
                                " m is less than half the distance of its ends; using " +
                                std::to_string(path.length() / std::numbers::pi) + " m"});
}

}  // namespace

void check_outline(const Pattern& pattern, const PatternPanel& panel, std::vector<Finding>& findings)
{
    check_loop(pattern, panel);
    std::vector<int> segments, edge_of_side;
    for (int edge = 0; edge < int(panel.edges.size()); ++edge) {
        check_edge(pattern, panel, edge, findings);
        segments.push_back(panel.edges[edge].curve == EdgeCurve::straight ? 1 : check_segments);
        edge_of_side.insert(edge_of_side.end(), segments.back(), edge);
    }
    const std::vector<Vec2> polygon = sample_outline(panel, segments);
    if (lies_on_a_line(polygon))
        throw InputError(pattern.place("pattern.panels." + panel.name), "an outline without area",
                         "a panel with an area");
    if (const auto crossing = crossing_sides(polygon)) {
        const int first = edge_of_side[(*crossing)[0]], second = edge_of_side[(*crossing)[1]];
        throw InputError(pattern.place(edge_key(panel, first)),
                         first == second ? "an edge that crosses or touches itself"
                                         : "an edge that crosses or touches edges[" + std::to_string(second) + "]",
                         "an outline that does not cross itself");
    }
}

double signed_area(const std::vector<Vec2>& polygon)
{
    double doubled = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec2 a = polygon[i] - polygon[0], b = polygon[(i + 1) % polygon.size()] - polygon[0];
        doubled += a.x() * b.y() - a.y() * b.x();
    }
    return 0.5 * doubled;
}

std::vector<Vec2> sample_outline(const PatternPanel& panel, const std::vector<int>& segments)
{
    std::vector<Vec2> polygon;
    for (std::size_t edge = 0; edge < panel.edges.size(); ++edge) {
        const EdgePath path(panel, panel.edges[edge]);
        for (int i = 0; i < segments[edge]; ++i) polygon.push_back(path.at(double(i) / segments[edge]));
    }
    return polygon;
}

}  // namespace selvage
