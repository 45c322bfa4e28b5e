#pragma once
// The alarms of one axis: those that hold now, and those not yet fetched by the machine. Bounded, real-time safe.

#include <array>
#include <span>

#include "axes/axis/alarms.hpp"

namespace taktwerk::axes {

class AlarmBoard {
public:
    explicit AlarmBoard(std::uint16_t axis) noexcept : axis_(axis) {}

    /// True when the alarm is new; one that already holds is not announced again.
    bool raise(AxisAlarm alarm, double a, double b) noexcept {
        if (holds(alarm)) return false;
        const AlarmFact fact{id(alarm), AlarmSource::axis, axis_, a, b};
        if (active_count_ < active_.size()) active_[active_count_++] = fact;
        if (fresh_count_ < fresh_.size()) fresh_[(fresh_first_ + fresh_count_++) % fresh_.size()] = fact;
        else ++dropped_;
        return true;
    }
    /// New numbers for an alarm that holds: what a drive tells only when it is asked again.
    void renumber(AxisAlarm alarm, double a, double b) noexcept {
        for (std::size_t i = 0; i < active_count_; ++i)
            if (active_[i].id == id(alarm)) active_[i].a = a, active_[i].b = b;
    }
    void clear(AxisAlarm alarm) noexcept {
        for (std::size_t i = 0; i < active_count_; ++i) {
            if (active_[i].id != id(alarm)) continue;
            for (std::size_t k = i + 1; k < active_count_; ++k) active_[k - 1] = active_[k];
            --active_count_;
            return;
        }
    }
    /// What a reset takes away; self-clearing alarms stay with their condition.
    void clear_all_but(AxisAlarm kept) noexcept {
        std::size_t left = 0;
        for (std::size_t i = 0; i < active_count_; ++i)
            if (active_[i].id == id(kept)) active_[left++] = active_[i];
        active_count_ = left;
    }
    [[nodiscard]] bool holds(AxisAlarm alarm) const noexcept {
        for (std::size_t i = 0; i < active_count_; ++i)
            if (active_[i].id == id(alarm)) return true;
        return false;
    }
    [[nodiscard]] std::span<const AlarmFact> active() const noexcept { return {active_.data(), active_count_}; }
    /// The oldest one not fetched yet.
    [[nodiscard]] bool fetch(AlarmFact& fact) noexcept {
        if (fresh_count_ == 0) return false;
        fact = fresh_[fresh_first_];
        fresh_first_ = (fresh_first_ + 1) % fresh_.size();
        --fresh_count_;
        return true;
    }
    [[nodiscard]] std::uint32_t dropped() const noexcept { return dropped_; }

private:
    std::uint16_t axis_;
    std::array<AlarmFact, axis_alarm_count> active_{};
    std::size_t active_count_ = 0;
    std::array<AlarmFact, 32> fresh_{};
    std::size_t fresh_first_ = 0, fresh_count_ = 0;
    std::uint32_t dropped_ = 0;
};

}  // namespace taktwerk::axes
