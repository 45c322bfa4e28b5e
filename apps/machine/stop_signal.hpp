#pragma once
// Signals that end a command, as a level: Ctrl-C, SIGTERM, a terminal that is gone (SIGHUP), Ctrl-\. For a running machine they go
// straight to its cycle: the axes stop along their ramps, power goes off, then the end.

namespace taktwerk::runtime {
class Machine;
}

namespace taktwerk::apps {

/// From now on SIGINT, SIGTERM, SIGHUP and SIGQUIT only set the level; a second one does not hurry a ramp. A SIGHUP that was ignored
/// (nohup) stays so.
void watch_stop_signals();
[[nodiscard]] bool stop_requested() noexcept;
/// Which signal it was, for the message; nullptr before.
[[nodiscard]] const char* stop_signal_name() noexcept;

/// For its lifetime the signals above raise the machine's shutdown themselves, in the handler: no thread has to look. Signals that would
/// end or stop the process at once for nothing (SIGUSR1, SIGUSR2, timers, Ctrl-Z, a background terminal, a file grown too large) are
/// ignored from then on. SIGKILL and SIGSTOP cannot be: then the drives' watchdogs act. `machine` outlives it.
class SignalsEndMachine {
public:
    explicit SignalsEndMachine(runtime::Machine& machine);
    ~SignalsEndMachine();
    SignalsEndMachine(const SignalsEndMachine&) = delete;
    SignalsEndMachine& operator=(const SignalsEndMachine&) = delete;
};

}  // namespace taktwerk::apps
