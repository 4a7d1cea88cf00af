#pragma once
#include <string>

#include "io/pattern/pattern.hpp"

namespace selvage {

/// Returns a pattern as GarmentCode JSON (Korosteleva and Sorkine-Hornung 2023) that read_pattern_json() reads back:
/// in cm, y up, R = Rz Ry Rx, control points relative to their edges. Bends of panels are in the key `wrap`, which
/// other programs do not know: there a bent panel starts flat, in the plane that touches its middle.
std::string pattern_json(const Pattern& pattern);

}  // namespace selvage
