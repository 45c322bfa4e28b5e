#pragma once
// What is done beside the cycle of a machine in real time, in an order that a recording can have (Machine::record(), RecordedThreads::several): on
// the cycle's thread, between two cycles. It never waits: while somebody else looks at the service side it is one cycle later.

#include <atomic>
#include <mutex>
#include <optional>

#include "core/clock.hpp"
#include "core/result.hpp"
#include "runtime/machine/machine.hpp"

namespace taktwerk::runtime {

class InStep {
public:
    /// Both outlive this.
    InStep(Machine& machine, Clock& clock) : machine_(machine), clock_(clock) {}

    /// Cycle thread, after each cycle: bus scripts, the drives' services, and what was asked for below. Not for hard real time: scripts allocate.
    void between_cycles();

    // --- another thread ---------------------------------------------------------------------------------------------------------
    /// For as long as it is held, the service side is the caller's.
    [[nodiscard]] std::unique_lock<std::mutex> look() { return std::unique_lock{service_side_}; }
    void start_bus() noexcept { start_.store(true); }
    void stop_bus() noexcept { stop_.store(true); }
    void arm() noexcept { arm_.store(true); }
    /// What came of arm(); nothing yet: it has not been its turn.
    [[nodiscard]] std::optional<Result<void>> armed() const;

private:
    Machine& machine_;
    Clock& clock_;
    std::mutex service_side_;
    std::atomic<bool> start_{false}, stop_{false}, arm_{false}, armed_{false};
    std::optional<Error> not_armed_;
};

}  // namespace taktwerk::runtime
