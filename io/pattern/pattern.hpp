#pragma once
#include <optional>
#include <string>
#include <vector>

#include "io/finding.hpp"
#include "io/geometry.hpp"

namespace selvage {

enum class EdgeCurve { straight, quadratic, cubic, arc };

/// One edge of a panel's closed outline, from vertex `start` to vertex `end`.
struct PatternEdge {
    int start = 0;
    int end = 0;
    EdgeCurve curve = EdgeCurve::straight;
    std::array<Vec2, 2> control{Vec2::Zero(), Vec2::Zero()};  ///< Bezier control points, panel coordinates [m].
    double radius = 0;                                        ///< Arc radius [m]; arc only.
    bool large_arc = false;                                   ///< As in an SVG path; arc only.
    bool right = false;                                       ///< Sweep flag as in an SVG path; arc only.
};

/// Rolls the flat panel onto a cylinder before it is placed, without stretching it. With folds it follows a meander
/// around the cylinder: the curve whose direction swings as a sine of its length (Langbein and Leopold 1966).
struct PanelWrap {
    double radius = 0;      ///< Cylinder radius [m]; the axis runs along the panel's y, above its line x = x0.
    double x0 = 0;          ///< Panel x [m] that stays in place (touches the flat plane z = 0).
    bool behind = false;    ///< False: the cylinder bends towards -z (edges move to -z); true: towards +z.
    double fold = 0;        ///< Length of cloth in each of the folds along y that the bend has [m]; 0: none.
    double fold_angle = 0;  ///< By which the cloth in a fold turns to either side of the cylinder [rad].
};

/// A flat piece of cloth: outline in the panel's own plane and its place in the scene.
/// A point (x, y) goes to rotation * roll(x, y) + translation, roll being (x, y, 0) without a wrap.
struct PatternPanel {
    std::string name;
    std::vector<Vec2> vertices;       ///< Outline corners [m].
    std::vector<PatternEdge> edges;   ///< A closed loop: edge k ends where edge k+1 starts.
    Vec3 translation = Vec3::Zero();  ///< [m], in the scene's frame.
    Mat3 rotation = Mat3::Identity();
    std::optional<PanelWrap> wrap;
    std::string fabric;  ///< Empty: the garment's fabric.
};

struct StitchSide {
    int panel = 0;
    int edge = 0;
};

/// A seam: two panel edges sewn together. They run in opposite directions unless `same_direction`.
struct PatternStitch {
    StitchSide a, b;
    bool same_direction = false;
};

/// A garment pattern in metres, in the scene's frame (z up).
struct Pattern {
    std::string name;
    std::vector<PatternPanel> panels;
    std::vector<PatternStitch> stitches;
    std::vector<Finding> findings;  ///< Values that the reader found unusual but could use.
    double units_in_meter = 100;    ///< Of the file's lengths.
    std::string file;               ///< That it was read from, or `builtin:NAME`.
    std::string text;               ///< Of the file, in which the places of findings are searched; may be empty.

    /// Returns the place of a key path such as `pattern.panels.front.edges[3]`, with its line where that is known.
    InputPlace place(const std::string& key) const;
};

/// Returns what a length would mean in each unit, such as "`100` for 1.7 m, `1000` for 0.17 m ...", the numbers being
/// values of properties.units_in_meter.
/// @param units  the length as the file has it
std::string unit_meanings(double units);

}  // namespace selvage
