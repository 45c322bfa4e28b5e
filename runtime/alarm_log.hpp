#pragma once
// The machine's list of alarms: what stands now, what waits to be acknowledged or reset. Each cycle everything that holds is
// raised again; what is not raised any more goes by its reset rule. Fixed capacity, real-time safe.

#include <array>
#include <cstdint>
#include <span>

#include "core/alarm.hpp"
#include "core/time.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::runtime {

class AlarmLog {
public:
    static constexpr std::size_t capacity = 64;

    void begin_cycle() noexcept;
    /// The condition holds in this cycle. `reaction` and `reset` come from the table of the fact's floor.
    void raise(const AlarmFact& fact, Reaction reaction, ResetRule reset, Instant now) noexcept;
    void end_cycle() noexcept;

    void acknowledge() noexcept;  ///< all of them
    void reset() noexcept;        ///< what needs a reset and does not hold any more goes

    /// The strongest reaction of what stands (for stop_axis: of no machine-wide meaning).
    [[nodiscard]] Reaction strongest() const noexcept;
    /// In order of their appearance.
    [[nodiscard]] std::span<const ActiveAlarm> alarms() const noexcept { return {alarms_.data(), count_}; }
    [[nodiscard]] std::uint32_t dropped() const noexcept { return dropped_; }

private:
    struct Rule {
        ResetRule reset;
        bool raised, was_reset;
    };
    void remove(std::size_t index) noexcept;

    std::array<ActiveAlarm, capacity> alarms_{};
    std::array<Rule, capacity> rules_{};
    std::size_t count_ = 0;
    std::uint32_t dropped_ = 0;
};

}  // namespace taktwerk::runtime
