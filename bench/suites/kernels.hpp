#pragma once
#include <iosfwd>
#include <string>
#include <vector>

namespace selvage {

/// Options of the suite `kernels`.
struct KernelOptions {
    int vertices = 100000;    ///< Approximate number of vertices of the cloth, in [16, 16e6].
    int threads = 0;          ///< 0: all cores.
    double min_time = 0.2;    ///< Least measured time per kernel [s].
    std::string filter = "";  ///< Regular expression that is searched in the kernels' names; empty: all kernels.
};

/// Reads `--vertices N`, `--threads N`, `--min-time S` and `--filter REGEX`; `--name=value` is the same.
/// @throws InputError for an unknown option, a missing value or one out of range
KernelOptions read_kernel_options(const std::vector<std::string>& options);

/// Measures every function of every force term and every stage of a step on a cloth in contact. The bytes that each
/// must move per second are compared with the speed at which this machine copies memory, measured in the same run.
/// Kernels are called repeatedly, so arrays that fit into the caches stay there: their fraction of the copy speed is
/// then above 1.
/// @param json  true: Google Benchmark's schema with the counters `items`, `bytes_per_item`, `ns_per_item` and
///              `copy_fraction`, and the machine in its context; false: a table
/// @throws InputError as read_kernel_options, and if the filter matches no kernel
void bench_kernels(bool json, const std::vector<std::string>& options, std::ostream& out);

}  // namespace selvage
