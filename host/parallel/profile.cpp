#include "host/parallel/profile.hpp"

namespace selvage {

void Profile::add(const KernelRecord& calls)
{
    for (KernelRecord& record : records_)
        if (record.name == calls.name) {
            record.calls += calls.calls;
            record.spent = record.spent + calls.spent;
            record.items += calls.items;
            record.bytes += calls.bytes;
            return;
        }
    records_.push_back(calls);
}

}  // namespace selvage
