#pragma once
#include <string>

#include "host/mannequin/mannequin_measures.hpp"
#include "host/mannequin/size_table.hpp"
#include "host/model/body.hpp"
#include "io/errors.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// Makes a tailor's mannequin with egg head, shaped torso, mitten hands and simple feet. z up, metres,
/// standing on z = 0 about x = y = 0, facing -y; the wearer's left is +x. A closed, outward oriented 2-manifold
/// with the parts head, neck, torso, left_arm, right_arm, left_leg, right_leg. The girths are those of a tape
/// (the convex hull of a horizontal section) and agree with the measures within 1 %.
/// @param body  where the measures stand, for messages
/// @throws InputError for measures outside the range in which the shape is sound
TriangleMesh make_mannequin(const MannequinMeasures& measures, const InputPlace& body = {"", 0, 0, "body"});

/// Returns the vertices of a mannequin that make_mannequin() made from these measures, with its arms turned about the
/// shoulder joints. The faces stay the same.
/// @param arm_angle  below the horizontal [degrees]
std::vector<Vec3> mannequin_with_arms(const TriangleMesh& mannequin, const MannequinMeasures& measures,
                                      double arm_angle);

/// The landmarks of the mannequin that make_mannequin() makes from the same measures.
/// @throws InputError as make_mannequin()
MannequinLandmarks mannequin_landmarks(const MannequinMeasures& measures);

}  // namespace selvage
