#include "host/parallel/copy_bandwidth.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <memory>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <unistd.h>

namespace selvage {
namespace {

constexpr std::size_t megabyte = std::size_t(1) << 20;

std::size_t last_level_cache_bytes()
{
    long bytes = 0;
    for (int level : {_SC_LEVEL2_CACHE_SIZE, _SC_LEVEL3_CACHE_SIZE, _SC_LEVEL4_CACHE_SIZE})
        bytes = std::max(bytes, sysconf(level));
    return std::size_t(bytes);
}

// Gives every thread one contiguous slice. Blocks this large are copied with non-temporal stores, so that the figure is
// not lowered by reading cache lines that are about to be overwritten.
template <class Body>
void for_each_slice(std::size_t bytes, int slices, const Body& body)
{
    tbb::parallel_for(
        tbb::blocked_range<int>(0, slices, 1),
        [&](const auto& range) {
            for (int slice = range.begin(); slice < range.end(); ++slice) {
                const std::size_t begin = bytes * std::size_t(slice) / std::size_t(slices);
                body(begin, bytes * std::size_t(slice + 1) / std::size_t(slices) - begin);
            }
        },
        tbb::static_partitioner());
}

}  // namespace

double measure_copy_bandwidth(std::size_t most_bytes, int passes)
{
    const std::size_t bytes = std::min(std::max(4 * last_level_cache_bytes(), 128 * megabyte), most_bytes);
    const int threads = tbb::this_task_arena::max_concurrency();
    const std::unique_ptr<std::byte[]> from(new std::byte[bytes]), to(new std::byte[bytes]);
    // First touch: every thread writes the pages that it will copy, so that they lie in the memory nearest to it.
    for_each_slice(bytes, threads, [&](std::size_t begin, std::size_t length) {
        std::memset(from.get() + begin, 1, length);
        std::memset(to.get() + begin, 0, length);
    });
    double fastest = 0;
    for (int pass = 0; pass < passes; ++pass) {
        const auto start = std::chrono::steady_clock::now();
        for_each_slice(bytes, threads, [&](std::size_t begin, std::size_t length) {
            std::memcpy(to.get() + begin, from.get() + begin, length);
        });
        asm volatile("" : : "r"(to.get()) : "memory");  // keeps the compiler from removing the copy
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        fastest = std::max(fastest, 2.0 * double(bytes) / seconds);
    }
    return fastest;
}

}  // namespace selvage
