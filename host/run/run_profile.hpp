#pragma once
#include "host/parallel/trace.hpp"
#include "io/run/profile_report.hpp"

namespace selvage {

/// Sums up a trace whose scopes are all closed: the phases by the tree of calls, the tracks by thread.
/// @param copy_bytes_per_second  of the machine; see measure_copy_bandwidth
ProfileReport profile_report(const Trace& trace, int threads, double copy_bytes_per_second);

/// Measures the machine's copy bandwidth, prints the table to stderr, and leaves trace.json in the folder of a run and
/// the table in its run.h5, if the run came so far that it has one.
void conclude_profile(const Trace& trace, const std::string& folder);

}  // namespace selvage
