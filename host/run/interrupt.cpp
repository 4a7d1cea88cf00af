#include "host/run/interrupt.hpp"

#include <atomic>
#include <csignal>
#include <ctime>

#include <unistd.h>

namespace selvage {
namespace {

// A signal that comes sooner after the first [ms] belongs to it: `timeout` and shells signal a process and its group.
// No one presses a key twice in that time on purpose; chosen by hand.
constexpr long same_request = 300;

// A signal handler gets no argument of ours, so these have to live outside of any object.
std::atomic<int> first_signal{0};
std::atomic<long> first_request{0};  // by SIGINT or SIGTERM [ms]; 0: none yet
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may not take a lock");
static_assert(std::atomic<long>::is_always_lock_free, "a signal handler may not take a lock");

long milliseconds()
{
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1000 * long(now.tv_sec) + now.tv_nsec / 1'000'000 + 1;
}

void on_signal(int signal)
{
    int none = 0;
    first_signal.compare_exchange_strong(none, signal);
    // The others repeat by themselves, at every write to a closed pipe, every second beyond the time limit; and who
    // asks a run to end after one of them, as batch systems do, asks for the first time.
    if (signal != SIGINT && signal != SIGTERM) return;
    const long now = milliseconds();
    long first = 0;
    if (first_request.compare_exchange_strong(first, now)) return;
    if (now - first > same_request) _exit(128 + signal);
}

}  // namespace

void install_interrupt_handler()
{
    struct sigaction action = {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;  // so that no write of a file is cut short
    for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
    for (const int signal : {SIGHUP, SIGXCPU, SIGPIPE}) {
        struct sigaction old = {};
        sigaction(signal, nullptr, &old);
        if (old.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
    }
}

bool interrupt_requested() { return first_signal.load(std::memory_order_relaxed) != 0; }

int interrupt_exit_code()
{
    const int signal = first_signal.load();
    return signal == 0 ? 0 : 128 + signal;
}

}  // namespace selvage
