#pragma once
#include <iosfwd>
#include <string>
#include <vector>

namespace selvage {

/// Runs sheets that swing down from one edge with every integrator, over stiffness from 1 to 1e7 N/m, bending rigidity
/// of 1e-7 and 1e-2 N m, edges of 2 to 50 mm and steps of 0.1 to 33 ms, through the whole program. Each is compared
/// with references by explicit schemes: it is accurate, or the program says that it is not.
/// Options: `--output FOLDER` (default bench-out), `--quick 1` for the largest sheets only.
/// Writes motion.json, .csv and .png there and prints counts, or the JSON.
/// @throws InputError for a bad option or a folder that cannot be written
void bench_motion(bool json, const std::vector<std::string>& options, std::ostream& out);

}  // namespace selvage
