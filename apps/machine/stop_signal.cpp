#include "apps/machine/stop_signal.hpp"

#include <csignal>

#include <atomic>

#include "runtime/machine/machine.hpp"

namespace taktwerk::apps {

namespace {

std::atomic<int> received{0};
std::atomic<runtime::Machine*> machine_to_end{nullptr};
static_assert(std::atomic<runtime::Machine*>::is_always_lock_free, "read by a signal handler");

void note(int signal) {
    received.store(signal, std::memory_order_relaxed);
    if (auto* machine = machine_to_end.load(std::memory_order_acquire)) machine->request_shutdown();
}

}  // namespace

void watch_stop_signals() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
        struct sigaction before {};
        sigaction(signal, nullptr, &before);
        if (signal == SIGHUP && before.sa_handler == SIG_IGN) continue;
        struct sigaction action {};
        action.sa_handler = note;
        action.sa_flags = SA_RESTART;  // a file that is being written is none of its business
        sigemptyset(&action.sa_mask);
        sigaction(signal, &action, nullptr);
    }
    std::signal(SIGPIPE, SIG_IGN);  // a client that goes away is an error of its socket, not the end of the machine
}

bool stop_requested() noexcept { return received.load(std::memory_order_relaxed) != 0; }

const char* stop_signal_name() noexcept {
    switch (received.load(std::memory_order_relaxed)) {
        case SIGINT: return "Ctrl-C";
        case SIGTERM: return "SIGTERM";
        case SIGHUP: return "SIGHUP (the terminal is gone)";
        case SIGQUIT: return "SIGQUIT";
        default: return nullptr;
    }
}

SignalsEndMachine::SignalsEndMachine(runtime::Machine& machine) {
    machine_to_end.store(&machine, std::memory_order_release);
    watch_stop_signals();
    for (const int signal : {SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGIO, SIGPWR, SIGTSTP, SIGTTIN, SIGTTOU, SIGXFSZ})
        std::signal(signal, SIG_IGN);
}

SignalsEndMachine::~SignalsEndMachine() { machine_to_end.store(nullptr, std::memory_order_release); }

}  // namespace taktwerk::apps
