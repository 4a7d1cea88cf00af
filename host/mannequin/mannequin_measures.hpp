#pragma once
#include <array>

#include "io/choices.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// Body measures of the built-in mannequin. Lengths in [m].
struct MannequinMeasures {
    BodyFigure figure = BodyFigure::women;  ///< Whose build: proportions, breasts, seat; not automatic.
    double stature = 1.70;
    double bust = 0.92;  ///< Tape girth at the bust line; of men and children the chest.
    double waist = 0.74;
    double hips = 1.00;
    double shoulder_width = 0.34;  ///< Between the two shoulder points of ISO 8559-1, straight across.
    double neck = 0.35;            ///< Girth at half the neck's height.
    double arm_length = 0.595;     ///< Shoulder point to wrist, along the arm in the A-pose.
    double arm_angle = 45;         ///< Degrees below the horizontal: 0 is a T-pose, 45 an A-pose; 0 to 80.
};

/// Points and heights of the mannequin for placing garments [m]. Pairs are {left, right} of the wearer.
struct MannequinLandmarks {
    double bust_height = 0, waist_height = 0, hip_height = 0, crotch_height = 0, neck_height = 0;
    double front = 0, back = 0;          ///< Least and greatest y of the torso.
    Vec3 neck_base = Vec3::Zero();       ///< Centre of the neck where it leaves the shoulders.
    std::array<Vec3, 2> neck_side;       ///< Where the shoulder line meets the neck, on the surface.
    std::array<Vec3, 2> shoulder_point;  ///< Outermost of the shoulder, on the surface: 45 degrees up from the joint.
    std::array<Vec3, 2> shoulder_joint;  ///< Centre of the upper arm's rounded end.
    std::array<Vec3, 2> armpit;          ///< On the surface, between arm and torso.
    std::array<Vec3, 2> arm_direction;   ///< Unit vector from the shoulder joint along the arm.
    std::array<Vec3, 2> wrist;           ///< Centre of the wrist.
    double upper_arm_radius = 0;         ///< Largest section radius below the shoulder.
    double wrist_radius = 0;
};

}  // namespace selvage
