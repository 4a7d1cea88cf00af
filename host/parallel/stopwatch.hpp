#pragma once
#include <chrono>
#include <ctime>

namespace selvage {

/// Wall time, and processor time of all threads of the process, which other programs on the machine do not lengthen
/// [s].
struct TimeSpent {
    double wall = 0, processor = 0;
};

inline TimeSpent operator+(const TimeSpent& a, const TimeSpent& b)
{
    return {a.wall + b.wall, a.processor + b.processor};
}
inline TimeSpent operator-(const TimeSpent& a, const TimeSpent& b)
{
    return {a.wall - b.wall, a.processor - b.processor};
}

/// Runs from its construction on.
class Stopwatch {
public:
    TimeSpent spent() const { return now() - start_; }

private:
    static TimeSpent now()
    {
        timespec processor{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &processor);
        return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
                double(processor.tv_sec) + 1e-9 * double(processor.tv_nsec)};
    }

    TimeSpent start_ = now();
};

}  // namespace selvage
