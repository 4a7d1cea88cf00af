#include "io/pattern/write_pattern.hpp"

#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "io/mesh/axes.hpp"

namespace selvage {
namespace {

using Json = nlohmann::ordered_json;

constexpr double units_in_meter = 100;

Json list_of(const Vec2& v) { return {v.x(), v.y()}; }
Json list_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

// Angles about x, y and z, in degrees, with R = Rz Ry Rx.
Vec3 angles_of(const Mat3& r)
{
    const double level = std::hypot(r(0, 0), r(1, 0));
    Vec3 angles(0, std::atan2(-r(2, 0), level), 0);
    if (level > 1e-9) {
        angles.x() = std::atan2(r(2, 1), r(2, 2));
        angles.z() = std::atan2(r(1, 0), r(0, 0));
    } else {
        angles.z() = std::atan2(-r(0, 1), r(1, 1));
    }
    return angles * 180 / std::numbers::pi;
}

// The control point along and across its edge, in units of the edge's length.
Json relative(const Vec2& control, const Vec2& start, const Vec2& end)
{
    const Vec2 along = end - start, across(-along.y(), along.x()), from_start = control - start;
    return list_of(Vec2(Vec2(from_start.dot(along), from_start.dot(across)) / along.squaredNorm()));
}

Json edge_json(const PatternPanel& panel, const PatternEdge& edge)
{
    Json json{{"endpoints", {edge.start, edge.end}}};
    const Vec2 &start = panel.vertices[edge.start], &end = panel.vertices[edge.end];
    if (edge.curve == EdgeCurve::quadratic) {
        json["curvature"] = {{"type", "quadratic"}, {"params", Json::array({relative(edge.control[0], start, end)})}};
    } else if (edge.curve == EdgeCurve::cubic) {
        json["curvature"] = {
            {"type", "cubic"},
            {"params", Json::array({relative(edge.control[0], start, end), relative(edge.control[1], start, end)})}};
    } else if (edge.curve == EdgeCurve::arc) {
        json["curvature"] = {
            {"type", "circle"},
            {"params", Json::array({units_in_meter * edge.radius, int(edge.large_arc), int(edge.right)})}};
    }
    return json;
}

Json panel_json(const PatternPanel& panel)
{
    const Mat3 to_file = z_up_from(Axis::y).transpose();
    Json json{{"translation", list_of(Vec3(units_in_meter * to_file * panel.translation))},
              {"rotation", list_of(angles_of(to_file * panel.rotation))},
              {"vertices", Json::array()},
              {"edges", Json::array()}};
    for (const Vec2& vertex : panel.vertices) json["vertices"].push_back(list_of(Vec2(units_in_meter * vertex)));
    for (const PatternEdge& edge : panel.edges) json["edges"].push_back(edge_json(panel, edge));
    if (panel.wrap)
        json["wrap"] = {{"radius", units_in_meter * panel.wrap->radius},
                        {"x0", units_in_meter * panel.wrap->x0},
                        {"behind", panel.wrap->behind},
                        {"fold", units_in_meter * panel.wrap->fold},
                        {"fold_angle", panel.wrap->fold_angle}};
    return json;
}

}  // namespace

std::string pattern_json(const Pattern& pattern)
{
    Json panels = Json::object(), order = Json::array(), stitches = Json::array();
    for (const PatternPanel& panel : pattern.panels) {
        panels[panel.name] = panel_json(panel);
        order.push_back(panel.name);
    }
    const auto side = [&](const StitchSide& at) {
        return Json{{"panel", pattern.panels[at.panel].name}, {"edge", at.edge}};
    };
    for (const PatternStitch& stitch : pattern.stitches) {
        Json pair = Json::array({side(stitch.a), side(stitch.b)});
        if (stitch.same_direction) pair.push_back("right_wrong");
        stitches.push_back(pair);
    }
    const Json json{{"pattern", {{"panels", panels}, {"stitches", stitches}, {"panel_order", order}}},
                    {"parameters", Json::object()},
                    {"parameter_order", Json::array()},
                    {"properties",
                     {{"curvature_coords", "relative"},
                      {"normalize_panel_translation", false},
                      {"normalized_edge_loops", true},
                      {"units_in_meter", units_in_meter}}}};
    return json.dump(1) + "\n";
}

}  // namespace selvage
