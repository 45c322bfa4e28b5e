#include "runtime/alarm_log.hpp"

namespace taktwerk::runtime {

void AlarmLog::begin_cycle() noexcept {
    for (std::size_t i = 0; i < count_; ++i) rules_[i].raised = false;
}

void AlarmLog::raise(const AlarmFact& fact, Reaction reaction, ResetRule reset, Instant now) noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        auto& alarm = alarms_[i];
        if (alarm.fact.id != fact.id || alarm.fact.source != fact.source || alarm.fact.index != fact.index) continue;
        rules_[i].raised = true;
        if (!alarm.standing) {
            alarm.standing = true;
            alarm.acknowledged = rules_[i].was_reset = false;
            ++alarm.count;
            alarm.fact = fact;
        }
        return;
    }
    if (count_ == capacity) {
        ++dropped_;
        return;
    }
    alarms_[count_] = {fact, now, 1, true, false, reaction};
    rules_[count_] = {reset, true, false};
    ++count_;
}

void AlarmLog::remove(std::size_t index) noexcept {
    for (std::size_t i = index + 1; i < count_; ++i) {
        alarms_[i - 1] = alarms_[i];
        rules_[i - 1] = rules_[i];
    }
    --count_;
}

void AlarmLog::end_cycle() noexcept {
    for (std::size_t i = 0; i < count_;) {
        auto& alarm = alarms_[i];
        alarm.standing = rules_[i].raised;
        bool gone = false;
        if (!alarm.standing) {
            switch (rules_[i].reset) {
                case ResetRule::self_clearing: gone = true; break;
                case ResetRule::acknowledge: gone = alarm.acknowledged; break;
                case ResetRule::reset: gone = rules_[i].was_reset; break;
                case ResetRule::restart: break;
            }
        }
        if (gone) remove(i);
        else ++i;
    }
    if (count_ < capacity) dropped_ = 0;
}

void AlarmLog::acknowledge() noexcept {
    for (std::size_t i = 0; i < count_; ++i) alarms_[i].acknowledged = true;
}

void AlarmLog::reset() noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        alarms_[i].acknowledged = true;
        rules_[i].was_reset = true;
    }
}

Reaction AlarmLog::strongest() const noexcept {
    Reaction strongest = Reaction::none;
    for (std::size_t i = 0; i < count_; ++i) {
        // A condition that needs a reset keeps its reaction until it is reset, even when it is gone.
        const bool holds = alarms_[i].standing || rules_[i].reset == ResetRule::reset || rules_[i].reset == ResetRule::acknowledge;
        if (holds && alarms_[i].reaction > strongest) strongest = alarms_[i].reaction;
    }
    return strongest;
}

}  // namespace taktwerk::runtime
