#pragma once
#include <iosfwd>
#include <string>
#include <vector>

namespace selvage {

/// Run time against error, for every integrator over steps, tolerances and precisions, on scenes of their own kinds:
/// a swinging sheet, a stiff cantilever, a drape over a sphere, and a search for the shape at rest. Errors are
/// distances to a double-precision run of another integrator whose own error is printed with them.
/// Options: `--scene NAME`, `--output FOLDER` (default bench-out), `--quick 1` for fewer points.
/// Writes work_precision.json, .csv and .png there and prints a table, or the JSON, and one sentence per scene.
/// @throws InputError for a bad option or a folder that cannot be written
void bench_work_precision(bool json, const std::vector<std::string>& options, std::ostream& out);

}  // namespace selvage
