#pragma once
#include <string>

#include "io/scene/fabric.hpp"
#include "io/scene/scene_reader.hpp"

namespace selvage {

/// Reads the keys of a fabric's table. Keys that it does not give come from the preset that its key `base` names,
/// or, without one, from the preset of the table's own name, if there is one; otherwise stiffness and mass must be
/// given.
/// @throws InputError naming the key, the value and what was expected.
Fabric read_fabric_table(TableReader& reader, const std::string& name);

/// Checks ranges and that the membrane resists every strain.
/// @throws InputError at the fabric's place
void check_fabric(const Fabric& fabric, const InputPlace& place);

}  // namespace selvage
