#pragma once
#include <optional>
#include <vector>

#include "host/body/anatomy.hpp"

namespace selvage {

/// A horizontal section of the trunk, arms left out.
struct TrunkSection {
    double z = 0;      ///< [m]
    double girth = 0;  ///< Of a tape [m].
    double front = 0;  ///< Least y [m].
    double back = 0;   ///< Greatest y [m].
};

/// Heights of the trunk's girths [m]. What the shape does not show is missing.
struct TrunkLevels {
    std::optional<double> bust, underbust, waist, hips;
    double neck = 0;                 ///< Where a horizontal tape around the neck is shortest.
    bool waist_is_narrowest = true;  ///< Else it is where the back is hollowest.
    bool hips_are_widest = true;     ///< Else they are where the seat is hindmost.
    bool bust_is_foremost = true;    ///< Else it is just below the armpits: nothing of the chest stands out.
};

/// Returns sections from the crotch to the crown, lowest first.
std::vector<TrunkSection> trunk_sections(const Anatomy& body);

/// Finds the levels at which a trunk is measured.
/// @throws InputError if there is no neck
TrunkLevels find_levels(const Anatomy& body, const std::vector<TrunkSection>& sections, const InputPlace& place);

}  // namespace selvage
