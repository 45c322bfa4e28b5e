#include "runtime/machine/alarm_log.hpp"

#include "axes/axis/alarms.hpp"
#include "runtime/alarms.hpp"

namespace taktwerk::runtime {

namespace {

constexpr auto full = id(MachineAlarm::alarm_log_full);
/// What appears within so long of one another belongs together: the watch of the bus needs some of it to name a slave.
constexpr Duration one_event = std::chrono::milliseconds{500};

/// How far down the chain of causes an alarm stands: this computer and its bus, slaves, programs, axes, and those that only say that they
/// stopped by another.
int distance(const AlarmFact& fact) noexcept {
    if (fact.id == full) return 5;
    if (fact.id == axes::id(axes::AxisAlarm::stopped_by_machine) || fact.id == axes::id(axes::AxisAlarm::axis_feedback_lost)) return 4;
    if (fact.id == id(MachineAlarm::emergency_stop) && fact.a == emergency_stop_unread) return 2;
    switch (fact.source) {
        case AlarmSource::slave: return 1;
        case AlarmSource::program: return 2;
        case AlarmSource::axis: return 3;
        default: return 0;
    }
}

}  // namespace

void AlarmLog::begin_cycle() noexcept {
    for (std::size_t i = 0; i < count_; ++i) rules_[i].raised = false;
    dropped_ = 0;
}

void AlarmLog::raise(const AlarmFact& fact, Reaction reaction, ResetRule reset, Instant now) noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        auto& alarm = alarms_[i];
        if (alarm.fact.id != fact.id || alarm.fact.source != fact.source || alarm.fact.index != fact.index) continue;
        rules_[i].raised = true;
        if (!alarm.standing) {
            alarm.standing = true;
            alarm.acknowledged = rules_[i].cleared = false;
            ++alarm.count;
        }
        alarm.fact = fact;  // its numbers may follow the condition
        return;
    }
    if (fact.id != full && !make_room(reaction)) return;
    auto at = count_++;
    for (; at > 0 && now - alarms_[at - 1].since < one_event && distance(alarms_[at - 1].fact) > distance(fact); --at) {
        alarms_[at] = alarms_[at - 1];
        rules_[at] = rules_[at - 1];
    }
    alarms_[at] = {fact, now, 1, true, false, reaction};
    rules_[at] = {reset, true, false};
}

void AlarmLog::withdraw(AlarmId id, const AlarmFact& better) noexcept {
    for (std::size_t i = 0; i < count_;) {
        const auto& fact = alarms_[i].fact;
        const bool same = better.source == AlarmSource::bus || fact.index == better.index;
        if (fact.id == id && fact.source == AlarmSource::slave && same && fact.a == 0 && !rules_[i].raised) remove(i);
        else ++i;
    }
}

bool AlarmLog::make_room(Reaction reaction) noexcept {
    std::size_t others = 0, weakest = count_;
    for (std::size_t i = 0; i < count_; ++i) {
        if (alarms_[i].fact.id == full) continue;
        ++others;
        if (weakest == count_ || alarms_[i].reaction <= alarms_[weakest].reaction) weakest = i;
    }
    if (others < capacity - 1) return true;
    ++dropped_;
    if (alarms_[weakest].reaction >= reaction) return false;
    remove(weakest);
    return true;
}

void AlarmLog::remove(std::size_t index) noexcept {
    for (std::size_t i = index + 1; i < count_; ++i) {
        alarms_[i - 1] = alarms_[i];
        rules_[i - 1] = rules_[i];
    }
    --count_;
}

void AlarmLog::end_cycle(Instant now) noexcept {
    if (dropped_ > 0) {
        const auto& info = *find_alarm(machine_alarms, full);
        raise({full, AlarmSource::machine, 0, static_cast<double>(dropped_), 0}, info.reaction, info.reset, now);
    }
    for (std::size_t i = 0; i < count_;) {
        auto& alarm = alarms_[i];
        const bool over = alarm.standing && !rules_[i].raised;
        alarm.standing = rules_[i].raised;
        if (alarm.standing) rules_[i].cleared = false;  // its cause came back at once
        if (over && rules_[i].reset != ResetRule::self_clearing) alarm.acknowledged = false;
        if (alarm.standing || (rules_[i].reset != ResetRule::self_clearing && !rules_[i].cleared)) {
            ++i;
            continue;
        }
        if (now - alarm.since < PassedAlarms::moment) passed_.note({alarm.fact, alarm.reaction, alarm.since, now});
        remove(i);
    }
}

void AlarmLog::acknowledge() noexcept {
    for (std::size_t i = 0; i < count_; ++i) acknowledge_at(i);
}

void AlarmLog::acknowledge(AlarmId id) noexcept {
    for (std::size_t i = 0; i < count_; ++i)
        if (alarms_[i].fact.id == id) acknowledge_at(i);
}

void AlarmLog::acknowledge_at(std::size_t index) noexcept {
    alarms_[index].acknowledged = true;
    rules_[index].cleared = rules_[index].cleared || (!alarms_[index].standing && rules_[index].reset == ResetRule::acknowledge);
}

bool AlarmLog::lists(AlarmId id) const noexcept {
    for (const auto& alarm : alarms())
        if (alarm.fact.id == id) return true;
    return false;
}

void AlarmLog::reset() noexcept {
    acknowledge();
    for (std::size_t i = 0; i < count_; ++i)
        rules_[i].cleared = rules_[i].cleared || (!alarms_[i].standing && rules_[i].reset == ResetRule::reset);
}

void AlarmLog::reset_with_cause(AlarmId id, AlarmSource source, std::uint16_t index) noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        const auto& fact = alarms_[i].fact;
        if (fact.id == id && fact.source == source && fact.index == index) rules_[i].cleared = true;
    }
}

const ActiveAlarm* AlarmLog::find(AlarmId id) const noexcept {
    for (std::size_t i = 0; i < count_; ++i)
        if (alarms_[i].fact.id == id) return &alarms_[i];
    return nullptr;
}

Reaction AlarmLog::strongest() const noexcept {
    Reaction strongest = Reaction::none;
    for (const auto& alarm : alarms())
        if (alarm.reaction > strongest) strongest = alarm.reaction;
    return strongest;
}

}  // namespace taktwerk::runtime
