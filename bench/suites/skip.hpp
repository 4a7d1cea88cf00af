#pragma once
#include <iosfwd>
#include <string>
#include <vector>

namespace selvage {

/// Runs one hanging sheet with each feature absent, declared but idle, and active, each run a process of its own, and
/// prints what that costs: time, memory, kernels launched and what was initialised. Runs are interleaved, and ratios
/// are taken from the fastest of each. Options: --resolution N (vertices a side), --repeats N, --until S (simulated),
/// --feature NAME, --program FILE.
/// @throws InputError for a bad option
void bench_skip(bool json, const std::vector<std::string>& options, std::ostream& out);

}  // namespace selvage
