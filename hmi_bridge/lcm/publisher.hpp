#pragma once
// The machine's state over LCM at its rate: encodes snapshots into buffers it keeps, on the service side. What changes slowly
// goes out slower (statistics 5 Hz, alarms at each change and 2 Hz, heartbeat 10 Hz). One thread, not real-time.

#include <cstdint>
#include <functional>
#include <memory>

#include "core/time.hpp"
#include "hmi_bridge/lcm/channels.hpp"
#include "hmi_bridge/lcm/message_bus.hpp"
#include "hmi_bridge/machine_link.hpp"
#include "hmi_bridge/state/whole_state.hpp"

namespace taktwerk::hmi {

class Publisher {
public:
    static constexpr std::size_t points_per_message = 32;
    static constexpr std::size_t values_per_message = 12;
    static constexpr std::size_t message_size_aim = 1400;  ///< one datagram on an ordinary network; a single long alarm may exceed it

    Publisher(MessageBus& bus, const MachineLink& machine, double rate_hz, bool commands_taken, std::function<std::int64_t()> wall_utime);
    ~Publisher();

    /// Whole states too, from now on (whole_state_v5_t). `run`: not 0, another one of each process.
    void publish_whole_states(std::int64_t run, NameOfClient who);

    /// Each service step: looks at the snapshot (nullptr before the first cycle) and publishes what is due.
    void step(const runtime::Snapshot* snapshot, Instant now);
    /// Messages the bus did not take.
    [[nodiscard]] std::uint64_t failed() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace taktwerk::hmi
