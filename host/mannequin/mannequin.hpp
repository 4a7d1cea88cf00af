#pragma once
#include <array>
#include <string>

#include "io/errors.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// Body measures of the built-in mannequin. Lengths in [m].
struct MannequinMeasures {
    double stature = 1.70;
    double bust = 0.92;  ///< Tape girth at the bust line.
    double waist = 0.74;
    double hips = 1.00;
    double shoulder_width = 0.40;  ///< Between the two shoulder points, straight across.
    double neck = 0.35;            ///< Girth at half the neck's height.
    double arm_length = 0.595;     ///< Shoulder point to wrist, along the arm in the A-pose.
    double arm_angle = 45;         ///< Degrees below the horizontal: 0 is a T-pose, 45 an A-pose; 0 to 80.
};

/// Where things are on the mannequin, for placing garments. [m]; pairs are {left, right} of the wearer.
struct MannequinLandmarks {
    double bust_height = 0, waist_height = 0, hip_height = 0, crotch_height = 0, neck_height = 0;
    double front = 0, back = 0;          ///< Least and greatest y of the torso.
    Vec3 neck_base = Vec3::Zero();       ///< Centre of the neck where it leaves the shoulders.
    std::array<Vec3, 2> neck_side;       ///< Where the shoulder line meets the neck, on the surface.
    std::array<Vec3, 2> shoulder_point;  ///< Outer end of the shoulder line, on the surface.
    std::array<Vec3, 2> shoulder_joint;  ///< Centre of the upper arm's rounded end.
    std::array<Vec3, 2> armpit;          ///< On the surface, between arm and torso.
    std::array<Vec3, 2> arm_direction;   ///< Unit vector from the shoulder joint along the arm.
    std::array<Vec3, 2> wrist;           ///< Centre of the wrist.
    double upper_arm_radius = 0;         ///< Largest section radius below the shoulder.
    double wrist_radius = 0;
};

/// Measures of the sizes "S", "M" and "L" (women's, after the ranges of EN 13402-3), in the A-pose.
/// @throws InputError for any other size
MannequinMeasures mannequin_size(const std::string& size);

/// Makes a tailor's mannequin with egg head, shaped torso, mitten hands and simple feet. z up, metres,
/// standing on z = 0 about x = y = 0, facing -y; the wearer's left is +x. A closed, outward oriented 2-manifold
/// with the parts head, neck, torso, left_arm, right_arm, left_leg, right_leg. The girths are those of a tape
/// (the convex hull of a horizontal section) and agree with the measures within 1 %.
/// @param body  where the measures stand, for messages
/// @throws InputError for measures outside the range in which the shape is sound
TriangleMesh make_mannequin(const MannequinMeasures& measures, const InputPlace& body = {"", 0, 0, "body"});

/// The vertices of a mannequin that make_mannequin() made from these measures, its arms turned about the shoulder
/// joints: a pose with the same faces. @param arm_angle  below the horizontal [degrees]
std::vector<Vec3> mannequin_with_arms(const TriangleMesh& mannequin, const MannequinMeasures& measures,
                                      double arm_angle);

/// The landmarks of the mannequin that make_mannequin() makes from the same measures.
/// @throws InputError as make_mannequin()
MannequinLandmarks mannequin_landmarks(const MannequinMeasures& measures);

}  // namespace selvage
