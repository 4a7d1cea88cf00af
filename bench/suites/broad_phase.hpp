#pragma once
#include <iosfwd>
#include <string>
#include <vector>

namespace selvage {

/// Measures how long it takes to find all pairs of primitives of a sheet that are within the gap of contact: by
/// ClothTree, and by rtcCollide over the same faces as user geometry. Both must find the same pairs; otherwise the
/// suite fails. A time step looks several times (8 to 12 times in the stress scenes), and candidates that are complete
/// still serve on. Options: --sides N[,N...] (vertices a side), --repeats N, --looks N (of a time step).
/// @throws InputError for a bad option
void bench_broad_phase(bool json, const std::vector<std::string>& options, std::ostream& out);

}  // namespace selvage
