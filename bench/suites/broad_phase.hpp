#pragma once
#include <iosfwd>
#include <string>
#include <vector>

namespace selvage {

/// Measures the time to find all pairs of primitives of a sheet whose distance is below the contact gap: by ClothTree,
/// and by rtcCollide over the same faces as user geometry. The suite fails unless both find the same pairs. A time step
/// queries the broad phase several times (8 to 12 times in the stress scenes); ClothTree reuses its candidates while
/// they are still complete. Options: --sides N[,N...] (vertices per side), --repeats N, --looks N (queries per step).
/// @throws InputError for a bad option
void bench_broad_phase(bool json, const std::vector<std::string>& options, std::ostream& out);

}  // namespace selvage
