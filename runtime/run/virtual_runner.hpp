#pragma once
// A machine and its world in virtual time: one thread calls everything in a fixed order, as fast as the CPU allows, with
// bit-identical results each time.

#include <functional>
#include <optional>

#include "core/clock.hpp"
#include "core/result.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/world/world.hpp"

namespace taktwerk::runtime {

class VirtualRunner {
public:
    /// Both outlive the runner. `clock` is where the world was started.
    VirtualRunner(Machine& machine, World& world, VirtualClock& clock);

    /// After each cycle, for whoever reads the trace, plays the operator, or checks something.
    std::function<void(Instant)> after_cycle;
    /// Before that, for whoever takes a recording away (Machine::record()).
    std::function<void()> drain;

    /// Bus into OP and machine armed. Fails with the bus' own words, or after `patience` and what many slaves take.
    [[nodiscard]] Result<void> bring_up(Duration patience = std::chrono::seconds{30});
    /// Runs cycles for `duration` of machine time, or until the machine has stopped.
    void run_for(Duration duration);
    /// Runs until `condition` holds after a cycle; false when `patience` passed before.
    bool run_until(const std::function<bool()>& condition, Duration patience);
    /// Ordered end: axes stop, power goes off, bus goes down.
    void shut_down();

    [[nodiscard]] Instant now() const noexcept { return clock_.now(); }

private:
    void one_cycle();

    Machine& machine_;
    World& world_;
    VirtualClock& clock_;
    Duration period_;
};

}  // namespace taktwerk::runtime
