#pragma once
#include <vector>

#include "host/styles/blocks/style_measures.hpp"
#include "io/pattern/pattern.hpp"

namespace selvage {

/// How far from the body panels start [m]. Chosen by hand: near enough that seams find their way, wide enough that
/// cloth and body do not touch at any resolution.
struct StartGaps {
    static constexpr double trunk = 0.020, limb = 0.012, neck = 0.008;
    static constexpr double beyond_shoulder = 0.055;  ///< From the shoulder to the top of a sleeve, along the arm.
    static constexpr double panels = 0.010;           ///< Between panels that could cross.
};

/// Places a panel upright beside a part of the body and bends it around an upright axis, as near as the points that it
/// covers allow: half around, so that it meets a like panel on the other side, if that clears the body; otherwise so
/// that its ends come as near as possible to the plane through the axis.
/// @param points   of the body [m]
/// @param axis     a point on the axis [m]
/// @param outward  level unit vector from the axis to the panel's middle
/// @param height   of the panel's line y = 0 [m]
/// @param middle   x of the panel's line that faces outward [m]
void hang_around(PatternPanel& panel, const std::vector<Vec3>& points, const Vec3& axis, const Vec3& outward,
                 double height, double middle = 0, double gap = StartGaps::trunk);

/// Lays a panel that hang_around() has placed half around the body into folds, as deep as clears the points that it
/// covers, and moves it so that its ends stay at the plane through the axis.
/// @param folds       from the panel's middle to each side
/// @param most_angle  of the folds, see PanelWrap [rad]
void fold_around(PatternPanel& panel, const std::vector<Vec3>& points, const Vec3& axis, const Vec3& outward, int folds,
                 double most_angle);

/// Places a panel upright and flat beside the body, as near as the points that it covers allow.
void hang_flat(PatternPanel& panel, const std::vector<Vec3>& points, const Vec3& axis, const Vec3& outward,
               double height, double middle = 0, double gap = StartGaps::trunk);

/// Rolls a panel around a limb: x runs around it, y up along it. The line x = middle is on the outside of the limb, the
/// ends meet inside, or leave a gap where the limb is wide.
/// @param points    of the limb [m]
/// @param start     point on the limb's axis at the panel's y = 0 [m]
/// @param along     unit vector down the limb
/// @param outward   unit vector across the limb, to the panel's middle
void roll_around(PatternPanel& panel, const std::vector<Vec3>& points, const Vec3& start, const Vec3& along,
                 const Vec3& outward, double middle = 0, double gap = StartGaps::limb);

/// Returns points along the outlines of panels as they are placed.
std::vector<Vec3> placed_outlines(const std::vector<PatternPanel>& panels);

/// Returns whether one of the points lies within the tube of a panel that roll_around() has placed, or nearly.
bool tube_holds(const PatternPanel& tube, const std::vector<Vec3>& points, double gap = StartGaps::panels);

/// Puts a panel where another one is, bent alike.
void place_like(PatternPanel& panel, const PatternPanel& other);

/// Moves a pattern from a body's own frame into that of its mesh.
void move_to_mesh(Pattern& pattern, const BodyFrame& frame);

}  // namespace selvage
