#pragma once
#include <cstddef>
#include <functional>

namespace selvage {

/// Runs many small measurements, one per thread at a time, because a small cloth cannot keep several threads busy.
/// @param count  of the measurements
/// @param run    measures the one of an index; called on several threads at once, each limited to itself
/// @param done   called after each measurement, never on two threads at once, with the number of those that are done
void run_side_by_side(std::size_t count, const std::function<void(std::size_t)>& run,
                      const std::function<void(std::size_t)>& done);

}  // namespace selvage
