#pragma once
#include <cstdint>

namespace selvage {

/// The largest resident size that this process has had [bytes].
std::int64_t peak_memory_bytes();

/// The memory that this process may use [bytes]: the machine's, or its control group's limit if that is lower.
std::int64_t physical_memory_bytes();

}  // namespace selvage
