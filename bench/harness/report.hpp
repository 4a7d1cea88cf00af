#pragma once
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace selvage {

/// The conditions that all results of a run share, apart from the machine and the build.
struct BenchContext {
    int threads = 1;
    double copy_bandwidth = 0;                       ///< Of this machine with these threads [bytes/s].
    std::vector<std::pair<std::string, int>> sizes;  ///< Such as {"vertices", 100489}.
};

/// Runs all registered benchmarks and prints them in the order of their registration.
/// @param json  true: Google Benchmark's schema, the context extended by `version`, `compiler`, `build_type`,
///              `instruction_set`, `cpu_name`, `threads`, `copy_bytes_per_second` and the sizes;
///              false: a table of the counters `items`, `ns_per_item`, `bytes_per_item` and `copy_fraction`
void run_and_report(const BenchContext& context, bool json, std::ostream& out);

}  // namespace selvage
