#pragma once
#include <string>

#include "io/choices.hpp"

namespace selvage {

/// Returns what an extent would be if the file's unit were another: `17 m as m, 1.7 m as dm, ...`.
/// @param extent  as it was read [m]
/// @param unit    in which it was read
std::string sizes_by_unit(double extent, LengthUnit unit);

}  // namespace selvage
