#pragma once
#include <string>

#include "io/scene/fabric.hpp"
#include "io/scene/scene_reader.hpp"

namespace selvage {

/// Returns the names of the built-in fabrics, sorted.
std::vector<std::string> fabric_preset_names();

/// Returns a built-in fabric.
/// @throws InputError naming the nearest preset if there is none of that name.
Fabric fabric_preset(const std::string& name);

/// Reads the keys of a fabric's table. Keys that it does not give come from the preset that its key `base` names,
/// or, without one, from the preset of the table's own name, if there is one; otherwise stiffness and mass must be
/// given.
/// @throws InputError naming the key, the value and what was expected.
Fabric read_fabric_table(TableReader& reader, const std::string& name);

/// Reads the fabrics of a TOML text that holds nothing else: [fabric.NAME] tables, or one fabric's keys as the built-in
/// ones are written.
/// @return none if the text is something else, such as a scene
/// @throws InputError as read_fabric_table, or if the text is no TOML
std::vector<Fabric> read_fabrics(const std::string& text, const std::string& file);

/// Checks ranges and that the membrane resists every strain.
/// @throws InputError at the fabric's place
void check_fabric(const Fabric& fabric, const InputPlace& place);

/// Checks ranges and units.
/// @param key  key path of the fabric's table, for messages
/// @throws InputError naming the key, the value and the accepted range.
void check_fabric(const Fabric& fabric, const std::string& file, const std::string& key);

}  // namespace selvage
