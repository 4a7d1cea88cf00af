#include "host/solver/profile.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace selvage {

void Profile::add(std::string_view name, double seconds, std::int64_t items, std::int64_t bytes)
{
    for (KernelRecord& record : records_)
        if (record.name == name) {
            ++record.calls;
            record.seconds += seconds;
            record.items += items;
            record.bytes += bytes;
            return;
        }
    records_.push_back({std::string(name), 1, seconds, items, bytes});
}

std::string Profile::table() const
{
    std::vector<KernelRecord> sorted = records_;
    std::sort(sorted.begin(), sorted.end(),
              [](const KernelRecord& a, const KernelRecord& b) { return a.seconds > b.seconds; });
    std::string text = fmt::format("{:<24} {:>8} {:>10} {:>12}\n", "kernel or stage", "calls", "seconds", "ns per item");
    for (const KernelRecord& r : sorted)
        text += fmt::format("{:<24} {:>8} {:>10.3f} {:>12.1f}\n", r.name, r.calls, r.seconds,
                            r.items > 0 ? 1e9 * r.seconds / double(r.items) : 0.0);
    return text;
}

}  // namespace selvage
