#pragma once
#include <array>
#include <vector>

#include "host/body/body_measures.hpp"
#include "io/errors.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// The measures from which garments are drafted [m], found on a body by measure_body().
struct StyleMeasures {
    double stature = 0;
    double bust = 0, waist = 0, hips = 0, neck = 0;
    double upper_arm = 0, wrist = 0, thigh = 0, ankle = 0;
    double neck_width = 0;      ///< Between the sides of the neck, straight.
    double shoulder_width = 0;  ///< Between the shoulder points, straight.
    double shoulder_drop = 0;   ///< From the side of the neck down to the shoulder point, upright.
    double armscye_depth = 0;   ///< From the side of the neck down to the armpit, upright.
    double neck_to_waist = 0;   ///< From the side of the neck down to the waist, upright.
    double waist_to_hips = 0;   ///< Upright.
    double body_rise = 0;       ///< From the waist down to the crotch, upright.
    double arm_length = 0;      ///< Shoulder point to wrist, straight.
    double inside_leg = 0;      ///< Crotch to the ground.
    double waist_to_knee = 0;   ///< Upright.
};

/// A body as a drafter sees it. Its own frame: it faces -y, its left is +x, the ground is z = 0, x = 0 is its middle
/// [m]. Pairs are {left, right} of the wearer.
struct StyleBody {
    StyleMeasures measures;
    BodyFrame frame;  ///< Of the mesh that was measured.
    double neck_side_height = 0, shoulder_height = 0, armpit_height = 0, bust_height = 0, waist_height = 0,
           hip_height = 0, crotch_height = 0;
    double waist_y = 0;  ///< Of the middle of the waist, between front and back.
    Vec3 neck_front = Vec3::Zero(), neck_back = Vec3::Zero();
    std::array<Vec3, 2> shoulder, armpit, wrist, ankle;
    std::vector<Vec3> all;                 ///< The body's vertices.
    std::vector<Vec3> trunk;               ///< Of torso and neck.
    std::vector<Vec3> head;                ///< Of the head.
    std::array<std::vector<Vec3>, 2> arm;  ///< Of an arm with its hand.
    std::array<std::vector<Vec3>, 2> leg;  ///< Of a leg with its foot.
};

/// Measures a body for drafting. Both sides get the mean of both.
/// @param place  the body in the user's input, for messages
/// @throws InputError as measure_body(), and for a measure that its shape does not show
StyleBody style_body(const TriangleMesh& mesh, const InputPlace& place);

}  // namespace selvage
