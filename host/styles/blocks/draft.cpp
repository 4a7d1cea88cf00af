#include "host/styles/blocks/draft.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "host/garment/outline.hpp"

namespace selvage {
namespace {

constexpr double same_point = 1e-9;  // [m]

}  // namespace

PanelDraft::PanelDraft(std::string name, const Vec2& start)
{
    panel.name = std::move(name);
    panel.vertices.push_back(start);
}

PatternEdge& PanelDraft::add(const Vec2& end, const std::string& edge)
{
    const int index = int(panel.edges.size()), start = index;
    const bool closes = index > 1 && (end - panel.vertices.front()).norm() < same_point;
    if (!closes) panel.vertices.push_back(end);
    if (!edge.empty()) edges[edge] = index;
    panel.edges.push_back({.start = start, .end = closes ? 0 : start + 1});
    return panel.edges.back();
}

PanelDraft& PanelDraft::line(const Vec2& end, const std::string& edge)
{
    add(end, edge);
    return *this;
}

PanelDraft& PanelDraft::curve(const Vec2& control, const Vec2& end, const std::string& edge)
{
    PatternEdge& added = add(end, edge);
    added.curve = EdgeCurve::quadratic;
    added.control[0] = control;
    return *this;
}

PanelDraft& PanelDraft::curve(const Vec2& first, const Vec2& second, const Vec2& end, const std::string& edge)
{
    PatternEdge& added = add(end, edge);
    added.curve = EdgeCurve::cubic;
    added.control = {first, second};
    return *this;
}

PanelDraft& PanelDraft::arc(double radius, bool right, const Vec2& end, const std::string& edge)
{
    PatternEdge& added = add(end, edge);
    added.curve = EdgeCurve::arc;
    added.radius = radius;
    added.right = right;
    return *this;
}

PanelDraft& PanelDraft::close(const std::string& edge) { return line(panel.vertices.front(), edge); }

double PanelDraft::length(const std::string& edge) const
{
    return EdgePath(panel, panel.edges[std::size_t(edges.at(edge))]).length();
}

PanelDraft unfolded(const PanelDraft& half, bool front)
{
    PanelDraft whole = half;
    PatternPanel& panel = whole.panel;
    whole.edges.clear();
    const int count = int(half.panel.edges.size()), last = int(half.panel.vertices.size()) - 1;
    for (int k = count - 1; k >= 0; --k) {
        const PatternEdge& from = half.panel.edges[k];
        if (k > 0) panel.vertices.push_back(mirrored(half.panel.vertices[from.start]));
        PatternEdge edge = from;
        edge.start = int(panel.edges.size());
        edge.end = k > 0 ? edge.start + 1 : 0;
        if (from.curve == EdgeCurve::quadratic) edge.control[0] = mirrored(from.control[0]);
        if (from.curve == EdgeCurve::cubic) edge.control = {mirrored(from.control[1]), mirrored(from.control[0])};
        panel.edges.push_back(edge);
    }
    if (last != count) throw std::logic_error("half a panel is an open outline: " + panel.name);
    for (const auto& [edge, index] : half.edges) {
        whole.edges[(front ? "left_" : "right_") + edge] = index;
        whole.edges[(front ? "right_" : "left_") + edge] = 2 * count - 1 - index;
    }
    return whole;
}

PanelDraft mirrored(const PanelDraft& draft, const std::string& name)
{
    PanelDraft image = draft;
    const int count = int(draft.panel.vertices.size());
    image.panel.name = name;
    for (int v = 0; v < count; ++v) image.panel.vertices[v] = mirrored(draft.panel.vertices[(count - v) % count]);
    // Edge k of the image is edge count - 1 - k, run through backwards.
    for (int k = 0; k < count; ++k) {
        const PatternEdge& from = draft.panel.edges[count - 1 - k];
        PatternEdge& to = image.panel.edges[k];
        to = from;
        to.start = k;
        to.end = (k + 1) % count;
        if (from.curve == EdgeCurve::quadratic) to.control[0] = mirrored(from.control[0]);
        if (from.curve == EdgeCurve::cubic) to.control = {mirrored(from.control[1]), mirrored(from.control[0])};
    }
    for (auto& [edge, index] : image.edges) index = count - 1 - index;
    return image;
}

void PatternDraft::add(const PanelDraft& draft)
{
    const int panel = int(pattern_.panels.size());
    pattern_.panels.push_back(draft.panel);
    for (const auto& [edge, index] : draft.edges) sides_[draft.panel.name + "." + edge] = {panel, index};
}

StitchSide PatternDraft::side(const std::string& edge) const
{
    const auto found = sides_.find(edge);
    if (found == sides_.end()) throw std::logic_error("a style sews an edge that it has not drawn: " + edge);
    return found->second;
}

void PatternDraft::sew(const std::string& a, const std::string& b)
{
    pattern_.stitches.push_back({.a = side(a), .b = side(b)});
}

double PatternDraft::length(const std::string& edge) const
{
    const StitchSide at = side(edge);
    const PatternPanel& panel = pattern_.panels[std::size_t(at.panel)];
    return EdgePath(panel, panel.edges[std::size_t(at.edge)]).length();
}

double root_of(double low, double high, const std::function<double(double)>& increasing)
{
    for (int halving = 0; halving < 50; ++halving) {
        const double middle = 0.5 * (low + high);
        (increasing(middle) < 0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace selvage
