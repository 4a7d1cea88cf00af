#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/parallel/stopwatch.hpp"
#include "host/parallel/trace.hpp"

namespace selvage {

/// Time and traffic of one kernel or stage over a run.
struct KernelRecord {
    std::string name;
    std::int64_t calls = 0;
    TimeSpent spent;
    std::int64_t items = 0;  ///< Over all calls.
    std::int64_t bytes = 0;  ///< Least memory traffic, over all calls; 0: not known.
};

/// Collects the time and memory traffic of the stages of a run. A timed stage costs a few clock reads, so the profile
/// is always on. Stages may lie within others: searches within the stages of contact. Each timed stage is also a scope
/// of the calling thread's trace, if it has one.
class Profile {
public:
    /// Adds calls to the record of their name.
    void add(const KernelRecord& calls);
    const std::vector<KernelRecord>& records() const { return records_; }

    /// Runs `body` and records it; returns what it returns.
    template <class Body>
    auto timed(std::string_view name, std::int64_t items, std::int64_t bytes, const Body& body)
    {
        struct Stop {
            Profile& profile;
            std::string_view name;
            std::int64_t items, bytes;
            Stopwatch watch{};
            ~Stop() { profile.add({std::string(name), 1, watch.spent(), items, bytes}); }
        } stop{*this, name, items, bytes};
        const TraceScope scope(name, bytes);
        return body();
    }

private:
    std::vector<KernelRecord> records_;
};

}  // namespace selvage
