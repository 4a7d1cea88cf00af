#pragma once
#include <functional>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include "host/parallel/items.hpp"
#include "host/parallel/trace.hpp"

// Tells the compiler that no item reads what another item writes, so that it may vectorise the loop. Every
// kernel guarantees this.
#ifdef __clang__
    #define INDEPENDENT_ITEMS _Pragma("clang loop vectorize(assume_safety)")
#else
    #define INDEPENDENT_ITEMS _Pragma("GCC ivdep")
#endif

namespace selvage {

/// Items of one task: few enough to balance the threads, enough to hide the cost of starting the task. Chosen by
/// hand; not measured.
constexpr int items_per_task = 1024;

/// Runs `body(item)` for every item in [0, count) on the TBB threads. Every task is recorded in the calling thread's
/// trace, if it has one.
template <class Body>
void for_each_item(int count, const Body& body)
{
    tbb::parallel_for(tbb::blocked_range<int>(0, count, items_per_task),
                      [body, mark = Trace::mark()](const auto& range) {
                          const TaskSpan span(mark);
                          const int end = range.end();
                          INDEPENDENT_ITEMS
                          for (int item = range.begin(); item < end; ++item) body(item);
                      });
}

/// Runs `body(item)` for the given items only.
template <class Body>
void for_each_item(const Items& items, const Body& body)
{
    if (items.list)
        for_each_item(items.count, [body, list = items.list](int i) { body(list[i]); });
    else
        for_each_item(items.count, body);
}

/// Runs `Kernel(item, &args)` for the given items, or for [0, count), on the TBB threads. A kernel writes only to its
/// own item, so items run in any order, in parallel and in SIMD lanes. `args` is copied into each task, where the
/// compiler can keep it in registers.
template <auto Kernel, class Args>
void launch(const Items& items, const Args& args)
{
    for_each_item(items, [args](int item) { Kernel(item, &args); });
}
template <auto Kernel, class Args>
void launch(int count, const Args& args)
{
    launch<Kernel>(Items{count}, args);
}

/// Returns the sum of `body(item)` over [0, count), accumulated in double precision.
/// The items are split the same way whatever the thread count, so the result is reproducible.
template <class Body>
double sum_items(int count, const Body& body)
{
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<int>(0, count, items_per_task), 0.0,
        [body, mark = Trace::mark()](const auto& range, double sum) {
            const TaskSpan span(mark);
            for (int item = range.begin(); item < range.end(); ++item) sum += body(item);
            return sum;
        },
        std::plus<>{});
}

/// Returns the sum over the given items only.
template <class Body>
double sum_items(const Items& items, const Body& body)
{
    if (!items.list) return sum_items(items.count, body);
    return sum_items(items.count, [body, list = items.list](int i) { return body(list[i]); });
}

/// Returns the sum of `Kernel(item, &args)` over the given items; see sum_items.
template <auto Kernel, class Args>
double launch_sum(const Items& items, const Args& args)
{
    return sum_items(items, [args](int item) { return double(Kernel(item, &args)); });
}

/// An item and its value.
struct ItemValue {
    double value = 0;
    int item = -1;  ///< -1: none.
};

/// Returns the largest `body(item)` over [0, count) that exceeds `above`, and the first item that has it; no item and
/// `above` if there is none. A value that is no number exceeds nothing.
template <class Body>
ItemValue largest_item(int count, double above, const Body& body)
{
    return tbb::parallel_reduce(
        tbb::blocked_range<int>(0, count, items_per_task), ItemValue{above},
        [body, mark = Trace::mark()](const auto& range, ItemValue most) {
            const TaskSpan span(mark);
            for (int item = range.begin(); item < range.end(); ++item)
                if (const double value = double(body(item)); value > most.value) most = {value, item};
            return most;
        },
        [](const ItemValue& earlier, const ItemValue& later) { return later.value > earlier.value ? later : earlier; });
}

/// Returns the largest `body(item)` over [0, count), or 0 if none is above that.
template <class Body>
double max_items(int count, const Body& body)
{
    return largest_item(count, 0, body).value;
}

/// Returns the largest `Kernel(item, &args)` over [0, count); see max_items.
template <auto Kernel, class Args>
double launch_max(int count, const Args& args)
{
    return max_items(count, [args](int item) { return Kernel(item, &args); });
}

}  // namespace selvage
