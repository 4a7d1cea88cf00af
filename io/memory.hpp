#pragma once
#include <cstdint>

namespace selvage {

/// Returns the largest resident size that this process has had [bytes].
std::int64_t peak_memory_bytes();

/// Returns the resident size that this process has now [bytes].
std::int64_t resident_memory_bytes();

/// Returns the memory that this process may use [bytes]: the machine's, or its control group's limit if that is lower.
std::int64_t physical_memory_bytes();

}  // namespace selvage
