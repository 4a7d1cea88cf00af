#pragma once
#include <functional>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "host/parallel/launch.hpp"

namespace selvage {

/// Returns the sum of what `add(item, sum)` adds over [0, count), for sums that are more than one number.
/// The items are split the same way whatever the thread count, so the result is reproducible.
/// @param zero  has +, and is what an empty sum is
template <class Sum, class Add>
Sum reduce_items(int count, const Sum& zero, const Add& add)
{
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<int>(0, count, items_per_task), zero,
        [&add, mark = Trace::mark()](const auto& range, Sum sum) {
            const TaskSpan span(mark);
            for (int item = range.begin(); item < range.end(); ++item) add(item, sum);
            return sum;
        },
        std::plus<>{});
}

}  // namespace selvage
