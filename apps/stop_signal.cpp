#include "apps/stop_signal.hpp"

#include <csignal>

#include <atomic>

namespace taktwerk::apps {

namespace {

std::atomic<int> received{0};

void note(int signal) { received.store(signal, std::memory_order_relaxed); }

}  // namespace

void watch_stop_signals() {
    struct sigaction action {};
    action.sa_handler = note;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);  // a client that goes away is an error of its socket, not the end of the machine
}

bool stop_requested() noexcept { return received.load(std::memory_order_relaxed) != 0; }

const char* stop_signal_name() noexcept {
    switch (received.load(std::memory_order_relaxed)) {
        case SIGINT: return "Ctrl-C";
        case SIGTERM: return "SIGTERM";
        default: return nullptr;
    }
}

}  // namespace taktwerk::apps
