#pragma once
// Alarms that came and went by themselves within a moment: whoever looks at the list now and then would never have seen them, and not know
// why the machine stopped. The newest few, each with a number. Fixed size, real-time safe.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/alarm.hpp"
#include "core/time.hpp"

namespace taktwerk::runtime {

struct PassedAlarm {
    AlarmFact fact;
    Reaction reaction = Reaction::none;
    Instant since{}, gone{};
};

class PassedAlarms {
public:
    /// Of a chattering machine some hundred pass between two looks; who misses some can count them.
    static constexpr std::size_t capacity = 256;
    /// What was listed for longer, everybody has seen.
    static constexpr Duration moment = std::chrono::seconds{1};

    void note(const PassedAlarm& alarm) noexcept { alarms_[noted_++ % capacity] = alarm; }
    /// Becomes what `newer` is, of which this was a copy earlier. Costs what came meanwhile.
    void follow(const PassedAlarms& newer) noexcept {
        for (auto number = std::max(noted_, newer.oldest()); number < newer.noted_; ++number) alarms_[number % capacity] = newer.at(number);
        noted_ = newer.noted_;
    }
    /// How many there were; they are numbered from 0.
    [[nodiscard]] std::uint64_t noted() const noexcept { return noted_; }
    /// The first that is still kept.
    [[nodiscard]] std::uint64_t oldest() const noexcept { return noted_ > capacity ? noted_ - capacity : 0; }
    /// `number`: oldest() .. noted() - 1.
    [[nodiscard]] const PassedAlarm& at(std::uint64_t number) const noexcept { return alarms_[number % capacity]; }

private:
    std::array<PassedAlarm, capacity> alarms_{};
    std::uint64_t noted_ = 0;
};

}  // namespace taktwerk::runtime
