#pragma once
#include <string>
#include <vector>

namespace selvage {

/// Returns the names of the suites that `run_bench` knows.
std::vector<std::string> bench_suites();

/// Measures one suite and prints the results to standard output.
/// @param json     true: Google Benchmark's JSON schema; false: a table
/// @param options  of the suite, such as {"--vertices", "100000"}
/// @return the exit code of the program
/// @throws InputError for an unknown suite, an unknown option or a value out of range
int run_bench(const std::string& suite, bool json, const std::vector<std::string>& options);

}  // namespace selvage
