#pragma once
#include <string>

namespace selvage {

/// Describes the contents of a run.h5: frames, points, triangles, time range, panels, size on disk, version.
/// @param json  true: JSON text; false: lines for a human reader
/// @throws InputError if the file is not a run.
std::string describe_run(const std::string& path, bool json);

}  // namespace selvage
