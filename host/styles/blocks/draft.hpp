#pragma once
#include <functional>
#include <map>
#include <string>

#include "io/pattern/pattern.hpp"

namespace selvage {

/// A panel while it is drawn: a closed outline, counter-clockwise, whose edges have names. Lengths in [m].
class PanelDraft {
public:
    PanelDraft(std::string name, const Vec2& start);

    PanelDraft& line(const Vec2& end, const std::string& edge = {});
    PanelDraft& curve(const Vec2& control, const Vec2& end, const std::string& edge = {});
    PanelDraft& curve(const Vec2& first, const Vec2& second, const Vec2& end, const std::string& edge = {});
    PanelDraft& arc(double radius, bool right, const Vec2& end, const std::string& edge = {});
    /// Ends the outline with a straight edge; an outline that has come back to its start needs none.
    PanelDraft& close(const std::string& edge = {});

    double length(const std::string& edge) const;

    PatternPanel panel;
    std::map<std::string, int> edges;  ///< Index of each edge that has a name.

private:
    PatternEdge& add(const Vec2& end, const std::string& edge);
};

/// Returns a whole panel from its half at x >= 0, an open outline from the bottom of the middle, x = 0, to its top.
/// Edges take the side as a prefix: `left_hem`, `right_hem`.
/// @param front  it faces forwards: x > 0 is the wearer's left
PanelDraft unfolded(const PanelDraft& half, bool front);

/// Returns a panel's mirror image with the same names of edges.
PanelDraft mirrored(const PanelDraft& draft, const std::string& name);

/// A garment while it is drawn.
class PatternDraft {
public:
    void add(const PanelDraft& draft);
    /// Sews two edges, named as `front.side`.
    void sew(const std::string& a, const std::string& b);
    /// Arc length of an edge, named as `front.side` [m].
    double length(const std::string& edge) const;
    /// Returns the pattern, its panels placed in the frame of the body.
    const Pattern& pattern() const { return pattern_; }

private:
    StitchSide side(const std::string& edge) const;

    Pattern pattern_;
    std::map<std::string, StitchSide> sides_;
};

/// Returns where an increasing function vanishes between low and high.
double root_of(double low, double high, const std::function<double(double)>& increasing);

/// Returns the mirror image of a point at x = 0.
inline Vec2 mirrored(const Vec2& point) { return {-point.x(), point.y()}; }

}  // namespace selvage
