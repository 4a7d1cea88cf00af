#pragma once
#include <nlohmann/json_fwd.hpp>

namespace selvage {

/// Adds what a measurement depends on: `version`, `compiler`, `flags`, `build_type`, `instruction_set`, `cpu_name`,
/// `memory_bytes`.
void describe_machine(nlohmann::ordered_json& context);

/// The context of a suite that does not run on Google Benchmark's loop, in its schema: `date`, `num_cpus` and the
/// above.
nlohmann::ordered_json bench_context(int threads);

}  // namespace selvage
