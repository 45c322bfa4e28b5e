#pragma once
// Whole states at their rate: the part of the publisher that says everything of one cycle at once. One thread, not real-time.

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "hmi_bridge/lcm/message_bus.hpp"
#include "hmi_bridge/state/whole_state.hpp"

namespace taktwerk::hmi {

class WholePublisher {
public:
    static constexpr Duration least_period = std::chrono::milliseconds{20};  ///< it carries what does not change, too

    /// `run`: not 0, another one of each process. `bus` and `machine` outlive it.
    WholePublisher(MessageBus& bus, const MachineLink& machine, Duration period, std::int64_t run, NameOfClient who);

    [[nodiscard]] bool due(Instant now);
    /// `seq`, `utime`: of this message. False: it did not go out.
    bool publish(const runtime::Snapshot& snapshot, std::int64_t seq, std::int64_t utime);

private:
    MessageBus& bus_;
    const MachineLink& machine_;
    std::string channel_;
    Duration period_;
    Instant next_{};
    NameOfClient who_;
    whole_state_v5_t message_{};  ///< its strings and arrays have their memory from one time to the next
    std::vector<std::byte> buffer_;
};

}  // namespace taktwerk::hmi
