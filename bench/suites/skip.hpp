#pragma once
#include <iosfwd>
#include <string>
#include <vector>

namespace selvage {

/// Runs one hanging sheet with each feature absent, declared but idle, and active, each run in a process of its own. It
/// prints the cost of each: time, memory, kernel launches and the libraries that were initialised. The repeats of all
/// cases are interleaved, and ratios are taken between the fastest repeats.
/// Options: --resolution N (vertices per side), --repeats N, --until S (simulated), --feature NAME, --program FILE.
/// @throws InputError for a bad option
void bench_skip(bool json, const std::vector<std::string>& options, std::ostream& out);

}  // namespace selvage
