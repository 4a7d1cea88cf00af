#pragma once
#include <cstddef>

namespace selvage {

/// Measures how fast memory can be copied: the fastest of several passes over arrays four times as large as the
/// caches of the last level together, each thread copying its own slice. Bytes read plus bytes written, as in STREAM
/// (McCalpin 1995), over seconds; run it inside the TBB arena whose threads are to be compared. [bytes/s]
/// @param most_bytes  no array is larger than this
/// @param passes      of which the fastest counts
double measure_copy_bandwidth(std::size_t most_bytes = std::size_t(1) << 30, int passes = 8);

}  // namespace selvage
