#pragma once
// A person's hands on a simulated machine while it runs: buttons, analog values, faults of the bus, of drives and mechanics. One language
// for `taktwerk sim` on a cable and for `taktwerk simulate` on a running machine.

#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "apps/machine/sim_happenings.hpp"
#include "ecat/sim/faults.hpp"

namespace taktwerk::apps {

struct SimWord {
    std::string_view word, arguments, effect;
};
/// Every word, those of the bus first.
[[nodiscard]] std::vector<SimWord> sim_words();

class SimHands {
public:
    /// Both outlive it.
    SimHands(runtime::World& world, const runtime::MachineConfig& machine);

    /// From any thread: understood and checked here, done by the next step(). "input start 1", "after 2s drive-fault x 0x3130",
    /// "unplug y_drive". Errors: fault.unknown (with the nearest word), fault.arguments, fault.no_target, fault.no_slave.
    [[nodiscard]] Result<void> ask(const std::string& line);
    /// On the thread that applies the world's events. Never waits: what is being asked at this moment is done one step later.
    void step(Instant now);

    /// Does it at once, on the thread of step(). Errors: as ask(), and those of FaultInjector.
    [[nodiscard]] Result<void> happen(const std::string& line, Instant now);
    /// Instant::max(): nothing waits.
    [[nodiscard]] Instant next_event() const noexcept { return std::min(injector_.next_event(), happenings_.next_event()); }

private:
    using Order = std::variant<runtime::SimulationEvent, ecat::sim::Fault>;
    [[nodiscard]] Result<Order> understand(const std::string& line) const;
    [[nodiscard]] Result<void> carry_out(Order order, Instant now);

    const runtime::MachineConfig& machine_;
    const runtime::World& world_;
    ecat::sim::FaultInjector injector_;
    Happenings happenings_;
    std::mutex mutex_;
    std::vector<Order> asked_;  // under mutex_
};

}  // namespace taktwerk::apps
