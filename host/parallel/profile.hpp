#pragma once
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/parallel/trace.hpp"

namespace selvage {

/// Time and traffic of one kernel or stage over a run.
struct KernelRecord {
    std::string name;
    std::int64_t calls = 0;
    double seconds = 0;
    std::int64_t items = 0;  ///< Over all calls.
    std::int64_t bytes = 0;  ///< Least memory traffic, over all calls; 0: not known.
};

/// Collects the time and memory traffic of the stages of a run. A timed stage costs a few clock reads, so the profile
/// is always on. Each timed stage is also a scope of the calling thread's trace, if it has one.
class Profile {
public:
    /// Adds one call.
    void add(std::string_view name, double seconds, std::int64_t items, std::int64_t bytes);
    const std::vector<KernelRecord>& records() const { return records_; }

    /// Runs `body` and records it; returns what it returns.
    template <class Body>
    auto timed(std::string_view name, std::int64_t items, std::int64_t bytes, const Body& body)
    {
        struct Stop {
            Profile& profile;
            std::string_view name;
            std::int64_t items, bytes;
            std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
            ~Stop()
            {
                profile.add(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                            items, bytes);
            }
        } stop{*this, name, items, bytes};
        const TraceScope scope(name, bytes);
        return body();
    }

private:
    std::vector<KernelRecord> records_;
};

}  // namespace selvage
