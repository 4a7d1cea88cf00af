#include "host/parallel/profile.hpp"

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

}  // namespace selvage
