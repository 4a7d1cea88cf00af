#pragma once
#include <cstddef>

namespace selvage {

/// Returns the memory bandwidth of a copy [bytes/s]: bytes read plus bytes written, over the seconds of the fastest of
/// several passes. As in STREAM (McCalpin 1995) the arrays are at least four times as large as the last-level cache.
/// Every thread of the calling TBB arena copies its own slice.
/// @param most_bytes  upper limit of the size of each of the two arrays [bytes]
/// @param passes      number of passes, of which the fastest counts
double measure_copy_bandwidth(std::size_t most_bytes = std::size_t(1) << 30, int passes = 8);

}  // namespace selvage
