#pragma once
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace selvage {

/// Adds the properties of the build and the machine that a measurement depends on: `version`, `compiler`, `flags`,
/// `build_type`, `instruction_set`, `cpu_name`, `memory_bytes`.
void describe_machine(nlohmann::ordered_json& context);

/// Returns the `context` object of Google Benchmark's schema for a suite that does not use its loop: `date`,
/// `num_cpus`, `threads` and everything that describe_machine adds.
nlohmann::ordered_json bench_context(int threads);

/// Returns an entry of its `benchmarks`, to which a suite adds what it counts: one iteration.
/// @param wall, processor  [s]
nlohmann::ordered_json timed_run(const std::string& name, double wall, double processor);

}  // namespace selvage
