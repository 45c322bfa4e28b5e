#pragma once
// Each alarm once, whoever looks at snapshots now and then: those in the list, and those that came and went in between. Service side.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "runtime/snapshot.hpp"

namespace taktwerk::runtime {

class NewAlarms {
public:
    /// `on_new(const AlarmFact&, Reaction, Instant since)` for each that was not there at the look before. False: it was none of interest,
    /// and is offered again as long as it is listed; it may become one.
    template <class OnNew>
    void look(const Snapshot& snapshot, OnNew on_new) {
        const auto& passed = snapshot.passed_alarms;
        for (auto number = std::max(next_passed_, passed.oldest()); number < passed.noted(); ++number)
            see(passed.at(number).fact, passed.at(number).reaction, passed.at(number).since, on_new);
        next_passed_ = passed.noted();
        const auto listed = [&](const Known& known) {
            return std::any_of(snapshot.alarms.begin(), snapshot.alarms.begin() + static_cast<std::ptrdiff_t>(snapshot.alarm_count),
                               [&](const ActiveAlarm& alarm) { return known.is(alarm.fact, alarm.since); });
        };
        std::erase_if(known_, [&](const Known& known) { return !listed(known); });
        for (std::size_t i = 0; i < snapshot.alarm_count; ++i)
            see(snapshot.alarms[i].fact, snapshot.alarms[i].reaction, snapshot.alarms[i].since, on_new);
    }

private:
    struct Known {
        AlarmFact fact;
        Instant since{};
        [[nodiscard]] bool is(const AlarmFact& other, Instant its_since) const {
            return fact.id == other.id && fact.source == other.source && fact.index == other.index && since == its_since;
        }
    };
    template <class OnNew>
    void see(const AlarmFact& fact, Reaction reaction, Instant since, OnNew& on_new) {
        if (std::any_of(known_.begin(), known_.end(), [&](const Known& known) { return known.is(fact, since); })) return;
        if (on_new(fact, reaction, since)) known_.push_back({fact, since});
    }

    std::vector<Known> known_;
    std::uint64_t next_passed_ = 0;
};

}  // namespace taktwerk::runtime
