#include "bench/harness/side_by_side.hpp"

#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include <tbb/task_arena.h>

namespace selvage {

void run_side_by_side(std::size_t count, const std::function<void(std::size_t)>& run,
                      const std::function<void(std::size_t)>& done)
{
    std::size_t next = 0, finished = 0;
    std::mutex access;
    std::exception_ptr failure;
    const auto work = [&] {
        tbb::task_arena alone(1);
        for (;;) {
            std::unique_lock lock(access);
            if (next == count || failure) return;
            const std::size_t i = next++;
            lock.unlock();
            std::exception_ptr fault;
            try {
                alone.execute([&] { run(i); });
            } catch (...) {
                fault = std::current_exception();
            }
            lock.lock();
            if (fault) {
                failure = fault;
                return;
            }
            done(++finished);
        }
    };
    std::vector<std::thread> threads;
    for (int t = 0; t < tbb::this_task_arena::max_concurrency(); ++t) threads.emplace_back(work);
    for (std::thread& thread : threads) thread.join();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace selvage
