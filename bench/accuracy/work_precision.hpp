#pragma once
#include <iosfwd>
#include <string>
#include <vector>

namespace selvage {

/// Measures run time against error for every integrator over steps, tolerances and precisions, on four kinds of scene:
/// a swinging sheet, a stiff cantilever, a drape over a sphere, and a search for the shape at rest. The error of a run
/// is its distance to a double-precision reference run of another integrator, whose own error is printed too.
/// Options: `--scene NAME`, `--output FOLDER` (default bench-out), `--quick 1` for fewer points.
/// Writes work_precision.json, .csv and .png there and prints a table, or the JSON, and one sentence per scene.
/// @throws InputError for a bad option or a folder that cannot be written
void bench_work_precision(bool json, const std::vector<std::string>& options, std::ostream& out);

}  // namespace selvage
