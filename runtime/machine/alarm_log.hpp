#pragma once
// The machine's list of alarms: what stands now, what waits to be acknowledged or reset. Each cycle everything that holds is
// raised again; what is not raised any more goes by its reset rule. Fixed capacity, real-time safe.
//
// A full list never hides a reaction: an alarm that finds no place takes that of the newest among the weakest, if that one reacts
// less. What finds none is counted, and the list says so in a place of its own (alarm_log_full).

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
    /// The condition holds in this cycle. `reaction` and `reset` come from the table of the fact's floor. The two numbers are those of the
    /// newest cycle in which it held: they may follow the condition, and a drive tells the detail of an alarm later.
    void raise(const AlarmFact& fact, Reaction reaction, ResetRule reset, Instant now) noexcept;
    /// `better` says what those with this id said of its slave (or of any, where it is the bus') before there was a reason: those of them that do
    /// not hold any more go, whatever their rule.
    void withdraw(AlarmId id, const AlarmFact& better) noexcept;
    void end_cycle(Instant now) noexcept;

    /// Marks all as seen; those whose rule is `acknowledge` and that do not hold any more go. One that still holds needs another
    /// acknowledgement when it is over.
    void acknowledge() noexcept;
    /// The same for one alarm of the machine.
    void acknowledge(AlarmId id) noexcept;
    [[nodiscard]] bool lists(AlarmId id) const noexcept;
    /// Acknowledges; and what needs a reset and does not hold any more goes. `restart` stays.
    void reset() noexcept;
    /// A reset has just taken its cause away: it goes with it, at the end of this cycle. Where the cause is there all the same it stays.
    void reset_with_cause(AlarmId id, AlarmSource source, std::uint16_t index) noexcept;

    /// The strongest reaction of what is listed: an alarm that waits for somebody reacts on.
    [[nodiscard]] Reaction strongest() const noexcept;
    /// The first with this id, or nullptr.
    [[nodiscard]] const ActiveAlarm* find(AlarmId id) const noexcept;
    /// In order of their appearance; of those that appear together, causes before what follows from them.
    [[nodiscard]] std::span<const ActiveAlarm> alarms() const noexcept { return {alarms_.data(), count_}; }
    /// Those that left the list by themselves, so soon that a reader may have missed them.
    [[nodiscard]] const PassedAlarms& passed() const noexcept { return passed_; }
    /// Conditions of the cycle before that found no place.
    [[nodiscard]] std::uint32_t dropped() const noexcept { return dropped_; }

private:
    struct Rule {
        ResetRule reset;
        bool raised, cleared;  // cleared: by the person its rule asks for, after it held
    };
    void acknowledge_at(std::size_t index) noexcept;
    bool make_room(Reaction reaction) noexcept;
    void remove(std::size_t index) noexcept;

    std::array<ActiveAlarm, capacity> alarms_{};
    std::array<Rule, capacity> rules_{};
    std::size_t count_ = 0;
    std::uint32_t dropped_ = 0;
    PassedAlarms passed_;
};

}  // namespace taktwerk::runtime
