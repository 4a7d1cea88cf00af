#pragma once
#include <array>
#include <optional>
#include <vector>

#include "host/body/anatomy.hpp"

namespace selvage {

/// A tape around a limb, and where it lies.
struct LimbTape {
    Tape tape;
    Vec3 middle = Vec3::Zero();  ///< Of the limb's section [m].
    Vec3 axis = Vec3::UnitZ();   ///< Unit, towards the limb's tip.
    double from_tip = 0;         ///< Geodesic distance from the tip of the hand [m]; of arms only.
};

/// The measured places of arms and legs; {left, right}. What the shape does not show is missing.
struct LimbLevels {
    std::array<std::optional<LimbTape>, 2> upper_arm, wrist;
    std::array<std::optional<LimbTape>, 2> thigh, knee, calf, ankle;
    bool knee_is_cap = true;  ///< Else it is the narrowest place between thigh and calf.
    /// Sections all along the limbs, from trunk to tip: across an arm, level around a leg.
    std::array<std::vector<LimbTape>, 2> arm_line, leg_line;
};

LimbLevels find_limb_levels(const Anatomy& body);

}  // namespace selvage
