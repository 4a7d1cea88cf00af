#pragma once
#include <string>
#include <vector>

#include "io/pattern/pattern.hpp"

namespace selvage {

/// The exact curve of one outline edge, parametrised by arc length.
class EdgePath {
public:
    /// @param panel  its checked panel, see check_outline
    EdgePath(const PatternPanel& panel, const PatternEdge& edge);

    double length() const { return length_; }  ///< [m], relative error below 1e-6.
    /// Returns the point at an arc-length fraction in [0, 1]; exactly the corners at 0 and 1.
    Vec2 at(double fraction) const;
    /// Whether an arc's radius was too small for its chord and was enlarged to half of it, as in SVG.
    bool radius_enlarged() const { return radius_enlarged_; }

private:
    void set_arc(const PatternEdge& edge);
    void measure_bezier();
    Vec2 bezier(double parameter) const;
    double bezier_speed(double parameter) const;
    double bezier_length(double from, double to) const;

    EdgeCurve curve_;
    Vec2 start_, end_;
    std::array<Vec2, 4> points_;         // cubic control polygon; a quadratic curve is stored as a cubic
    std::vector<double> length_before_;  // arc length up to each of equal steps of the Bezier parameter
    Vec2 centre_ = Vec2::Zero();
    double radius_ = 0, first_angle_ = 0, swept_angle_ = 0;
    bool radius_enlarged_ = false;
    double length_ = 0;
};

/// Returns the key path of an outline edge, such as `pattern.panels.front.edges[3]`.
std::string edge_key(const PatternPanel& panel, int edge);

/// Checks that a panel's edges form one closed loop that does not cross itself and has an area.
/// @param findings  gets one for every arc whose radius had to be enlarged
/// @throws InputError naming the panel or edge
void check_outline(const Pattern& pattern, const PatternPanel& panel, std::vector<Finding>& findings);

/// Returns the signed area of a closed polygon [m^2], positive if counter-clockwise.
double signed_area(const std::vector<Vec2>& polygon);

/// Returns the closed polygon through equally spaced points of every edge, in the order of the edges.
/// @param segments  of each edge, >= 1
std::vector<Vec2> sample_outline(const PatternPanel& panel, const std::vector<int>& segments);

}  // namespace selvage
