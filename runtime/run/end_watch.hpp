#pragma once
// The end of a run, seen from outside it: once somebody has asked for it, it comes within the promised time, whatever hangs. A base task
// or a slower task that never returns, a start() that waits, a bus that does not answer: then the process has to be ended as it is, and
// the drives' watchdogs do the rest (docs/faults.md, "When the master is gone").

#include <atomic>
#include <optional>

#include "core/result.hpp"
#include "core/time.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/run/advance_watch.hpp"

namespace taktwerk::runtime {

class EndWatch {
public:
    explicit EndWatch(const Machine& machine) : machine_(machine), cycle_(machine) {}

    /// Any thread: the cycle and the bus are down, only threads are left to come home.
    void only_threads_left() noexcept { only_threads_left_.store(true, std::memory_order_release); }
    /// The error says why the process cannot end by itself: end it now. Often enough for AdvanceWatch.
    [[nodiscard]] std::optional<Error> look(Instant now);
    [[nodiscard]] const std::optional<StuckCycle>& stuck() const noexcept { return stuck_; }

private:
    [[nodiscard]] std::string who() const;

    const Machine& machine_;
    AdvanceWatch cycle_;
    std::optional<StuckCycle> stuck_;
    std::optional<Instant> asked_, alone_;
    std::atomic<bool> only_threads_left_{false};
};

}  // namespace taktwerk::runtime
