#pragma once
#include <array>

#include "host/body/anatomy.hpp"

namespace selvage {

/// Neck and shoulders. Pairs are {left, right} of the wearer; points on the skin in the body's frame [m].
struct Shoulders {
    Vec3 neck_middle = Vec3::Zero();  ///< Of the narrowest section of the neck.
    Vec3 neck_axis = Vec3::UnitZ();   ///< Unit, upwards.
    Tape neck;                        ///< The shortest one across the axis.
    std::array<Vec3, 2> neck_side;    ///< Where the shoulder rises into the neck.
    Vec3 neck_front = Vec3::Zero();   ///< Hollow of the throat.
    Vec3 neck_back = Vec3::Zero();    ///< In the middle of the back, level with the sides.
    /// {front, back}: around each half and straight across from side to side; empty where a half is not found.
    std::array<Tape, 2> neck_base;
    std::array<Vec3, 2> shoulder;  ///< Top of the section through the armpit.

    /// Returns whether a point lies above the neck's base, which bends along the line between its sides.
    bool above_neck_base(const Vec3& point) const;
};

/// @param neck_level  height of the shortest horizontal tape around the neck [m]
/// @throws InputError if the shoulders do not widen below the neck
Shoulders find_shoulders(const Anatomy& body, double neck_level, const InputPlace& place);

}  // namespace selvage
