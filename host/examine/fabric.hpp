#pragma once
#include <vector>

#include "io/finding.hpp"
#include "io/scene/fabric.hpp"

namespace selvage {

/// Looks for values of a fabric that can be used but contradict what cloth is: densities and rigidities that look like
/// a slip of unit, and missing stiffness.
/// @param place  of the fabric's table, or of the key that names it
std::vector<Finding> examine_fabric(const Fabric& fabric, const InputPlace& place);

}  // namespace selvage
