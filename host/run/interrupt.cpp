#include "host/run/interrupt.hpp"

#include <atomic>
#include <csignal>

#include <unistd.h>

namespace selvage {
namespace {

// A signal handler gets no argument of ours, so this one flag has to live outside of any object.
std::atomic<int> received_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may not take a lock");

void on_signal(int signal)
{
    if (received_signal.exchange(signal) != 0) _exit(128 + signal);
}

}  // namespace

void install_interrupt_handler()
{
    struct sigaction action = {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;  // so that no write of a file is cut short
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

bool interrupt_requested() { return received_signal.load(std::memory_order_relaxed) != 0; }

int interrupt_exit_code()
{
    const int signal = received_signal.load();
    return signal == 0 ? 0 : 128 + signal;
}

}  // namespace selvage
