#pragma once
#include <array>

#include "host/body/anatomy.hpp"

namespace selvage {

/// Neck and shoulders. Pairs are {left, right} of the wearer; points on the skin in the body's frame [m].
struct Shoulders {
    Vec3 neck_middle = Vec3::Zero();  ///< Of the narrowest section of the neck.
    Vec3 neck_axis = Vec3::UnitZ();   ///< Unit, upwards.
    Tape neck;                        ///< The shortest one across the axis.
    Tape neck_base;                   ///< Through the points of the neck at the sides, across the axis.
    Vec3 neck_front = Vec3::Zero(), neck_back = Vec3::Zero();  ///< Of its base, in the middle.
    std::array<Vec3, 2> neck_side;                             ///< Where the shoulder rises into the neck.
    std::array<Vec3, 2> shoulder;                              ///< Top of the section through the armpit.
};

/// @param neck_level  height of the shortest horizontal tape around the neck [m]
/// @throws InputError if the shoulders do not widen below the neck
Shoulders find_shoulders(const Anatomy& body, double neck_level, const InputPlace& place);

}  // namespace selvage
