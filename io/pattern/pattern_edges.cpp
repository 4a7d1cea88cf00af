#include "io/pattern/pattern_edges.hpp"

#include <algorithm>
#include <cmath>

#include "io/number_text.hpp"

namespace selvage {
namespace {

// Limits beyond which an outline is a mistake. They were chosen by hand, far outside the sizes of clothes.
struct OutlineLimits {
    static constexpr double shortest_edge = 1e-5;   // distance of an edge's ends [m]
    static constexpr double farthest_control = 10;  // distance of a control point from its edge's start [m]
    static constexpr double smallest_area = 1e-8;   // area within the outline [m^2]
};

const Vec2& corner(const PatternPanel& panel, int vertex) { return panel.vertices[std::size_t(vertex)]; }

void read_endpoints(const JsonCursor& cursor, const PatternPanel& panel, PatternEdge& edge)
{
    const int last = int(panel.vertices.size()) - 1;
    const std::string expected = "two vertex indices from 0 to " + std::to_string(last);
    if (cursor.list(expected).size() != 2) cursor.refuse(expected);
    edge.start = cursor.at(0).integer(expected);
    edge.end = cursor.at(1).integer(expected);
    if (std::min(edge.start, edge.end) < 0 || std::max(edge.start, edge.end) > last) cursor.refuse(expected);
    const double length = (corner(panel, edge.end) - corner(panel, edge.start)).norm();
    if (length < OutlineLimits::shortest_edge)
        cursor.refuse_as("an edge of length " + rounded_text(length) + " m",
                         "ends that are at least " + number_text(OutlineLimits::shortest_edge) + " m apart");
}

Vec2 control_point(const JsonCursor& cursor, const PatternUnits& units, const PatternPanel& panel,
                   const PatternEdge& edge)
{
    const Vec2 given = cursor.vector2("a control point [u, v]");
    const Vec2 start = corner(panel, edge.start), along = corner(panel, edge.end) - start;
    const Vec2 across(-along.y(), along.x());
    const Vec2 point =
        units.relative_controls ? Vec2(start + given.x() * along + given.y() * across) : Vec2(units.scale * given);
    if (!((point - start).norm() <= OutlineLimits::farthest_control))
        cursor.refuse("a control point within " + number_text(OutlineLimits::farthest_control) + " m of its edge");
    return point;
}

void read_arc(const JsonCursor& params, const PatternUnits& units, const PatternPanel& panel, PatternEdge& edge,
              std::vector<Finding>& findings)
{
    const std::string expected = "[radius, large_arc, right]";
    if (params.list(expected).size() != 3) params.refuse(expected);
    edge.radius = units.scale * params.at(0).number("a radius in the pattern's unit");
    edge.large_arc = params.at(1).flag("1 for the larger arc, otherwise 0");
    edge.right = params.at(2).flag("1 for an arc on the right of the edge, otherwise 0");
    const double least = (corner(panel, edge.end) - corner(panel, edge.start)).norm() / 2;
    const JsonCursor radius = params.at(0);
    if (!(edge.radius >= 0.99 * least && edge.radius <= 1e4))
        radius.refuse("at least half of the edge's length, " + rounded_text(least / units.scale) +
                      ", in the pattern's unit");
    if (edge.radius < 0.9999 * least)
        findings.push_back({"arc", radius.place(), "is less than half of the edge's length and was enlarged to it"});
    edge.radius = std::max(edge.radius, least);
}

void read_curvature(const JsonCursor& cursor, const PatternUnits& units, const PatternPanel& panel, PatternEdge& edge,
                    std::vector<Finding>& findings)
{
    // Older files write a quadratic curve as a bare control point.
    if (cursor.value().is_array()) {
        edge.curve = EdgeCurve::quadratic;
        edge.control[0] = control_point(cursor, units, panel, edge);
        return;
    }
    if (!cursor.value().is_object()) cursor.refuse("a curve {type, params} or a control point [u, v]");
    const std::vector<std::string> kinds{"quadratic", "cubic", "circle"};
    const JsonCursor type = cursor.at("type"), params = cursor.at("params");
    const std::string kind = type.text("quadratic, cubic or circle");
    if (kind == "circle") {
        edge.curve = EdgeCurve::arc;
        read_arc(params, units, panel, edge, findings);
        return;
    }
    if (kind != "quadratic" && kind != "cubic") type.refuse("quadratic, cubic or circle", nearest_name(kind, kinds));
    edge.curve = kind == "cubic" ? EdgeCurve::cubic : EdgeCurve::quadratic;
    const int count = kind == "cubic" ? 2 : 1;
    const std::string expected = count == 2 ? "two control points [[u, v], [u, v]]" : "one control point [[u, v]]";
    if (params.list(expected).size() != count) params.refuse(expected);
    for (int k = 0; k < count; ++k) edge.control[std::size_t(k)] = control_point(params.at(k), units, panel, edge);
}

void check_loop(const JsonCursor& cursor, const PatternPanel& panel)
{
    const int edge_count = int(panel.edges.size());
    std::vector<int> visits(panel.vertices.size(), 0);
    bool straight = true;
    double area = 0;
    for (int k = 0; k < edge_count; ++k) {
        const PatternEdge& edge = panel.edges[std::size_t(k)];
        const int next = (k + 1) % edge_count;
        if (edge.end != panel.edges[std::size_t(next)].start)
            cursor.at(next).refuse_as("an outline that is open: edge " + std::to_string(k) + " ends at vertex " +
                                          std::to_string(edge.end) + " and edge " + std::to_string(next) +
                                          " starts at vertex " + std::to_string(panel.edges[std::size_t(next)].start),
                                      "a closed loop in which each edge starts where the one before ends");
        if (++visits[std::size_t(edge.start)] > 1)
            cursor.at(k).refuse_as("vertex " + std::to_string(edge.start) + " a second time",
                                   "a loop that passes each vertex once");
        straight = straight && edge.curve == EdgeCurve::straight;
        const Vec2 &a = corner(panel, edge.start), &b = corner(panel, edge.end);
        area += (a.x() * b.y() - a.y() * b.x()) / 2;
    }
    if (straight && std::abs(area) < OutlineLimits::smallest_area)
        cursor.refuse_as("an outline around " + rounded_text(std::abs(area)) + " m^2",
                         "an area of at least " + number_text(OutlineLimits::smallest_area) + " m^2");
}

}  // namespace

void read_edges(const JsonCursor& cursor, const PatternUnits& units, PatternPanel& panel,
                std::vector<Finding>& findings)
{
    cursor.list("a list of edges");
    if (cursor.size() < 2) cursor.refuse_as(std::to_string(cursor.size()) + " edges", "at least 2 edges");
    for (int k = 0; k < cursor.size(); ++k) {
        const JsonCursor item = cursor.at(k);
        PatternEdge& edge = panel.edges.emplace_back();
        read_endpoints(item.at("endpoints"), panel, edge);
        if (item.has("curvature") && !item.at("curvature").value().is_null())
            read_curvature(item.at("curvature"), units, panel, edge, findings);
    }
    check_loop(cursor, panel);
}

}  // namespace selvage
