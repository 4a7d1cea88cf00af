#pragma once
#include <array>
#include <vector>

#include "host/mannequin/section_tube.hpp"
#include "io/choices.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// A section of the torso. Its proportions are those of `section`; its size
/// comes from the girths: it is as long around as the sum of the bust, waist
/// and hip girths with these weights, so between two levels it lies between
/// their girths.
struct TorsoStation {
    TubeStation section;
    double bust = 0, waist = 0, hips = 0;
};

/// An ellipsoid at x >= 0 that is joined to the torso with a fillet, and
/// mirrored.
struct Bump {
    Vec3 centre = Vec3::Zero(), radii = Vec3::Ones();
    double fillet = 0.05;
};

/// How a figure is built, drawn by hand for a stature of 1.70 m and the girths
/// below [m]; z is a height.
struct FigureDrawing {
    double bust = 0, hips = 0, shoulder_width = 0;  ///< Girths for which bumps and limbs are drawn.
    std::vector<TorsoStation> torso;                ///< From the groin to the shoulders.
    Bump chest, shoulder_blade,
        seat;                         ///< Breast or pectoral muscle; blade; buttock.
    double upper_arm = 1, wrist = 1;  ///< Girths over those of a woman.
    double arm_growth = 0.8;          ///< Power of the bust girth with which the upper arm grows.
    double hand = 1,
           foot = 1;              ///< Lengths over those of a woman of the same stature.
    double shoulder = 1;          ///< Radius of the shoulder over that of a woman.
    double bust_height = 1.215;   ///< Of the foremost point of the chest.
    double waist_height = 1.065;  ///< Of the narrowest place.
    double hip_height = 0.875;    ///< Of the widest place.
};

const FigureDrawing& drawing_of(BodyFigure figure);

/// Heights of the drawing and of the body: children have longer heads and
/// trunks and shorter legs. Piecewise linear.
class HeightScale {
public:
    HeightScale() = default;
    HeightScale(BodyFigure figure, double stature);

    double operator()(double drawn) const;   ///< Height on the body for one of the drawing [m].
    double youth() const { return youth_; }  ///< 0 for adults, 1 for a child of 1.10 m.

private:
    static constexpr int knot_count = 8;
    std::array<double, knot_count> heights_{};
    double youth_ = 0;
};

}  // namespace selvage
