#pragma once
#include <string>

namespace selvage {

/// Describes what a file holds, by its content: a run (HDF5), a mesh (OBJ), a pattern (JSON), a scene or fabrics
/// (TOML); also builtin:NAME and the name of a built-in fabric.
/// @param json  true: JSON text; false: lines for a human reader
/// @throws InputError if there is no such file or it cannot be read as what it seems to be
std::string describe_file(const std::string& source, bool json);

}  // namespace selvage
