#pragma once
#include <string>

namespace selvage {

/// Says what a run.h5 holds: frames, points, triangles, time range, panels, size on disk, version.
/// @param json  JSON text instead of lines for a reader
/// @throws InputError if the file is not a run.
std::string describe_file(const std::string& path, bool json);

}  // namespace selvage
