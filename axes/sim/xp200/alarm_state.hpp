#pragma once
// The alarm that a simulated XP200 shows, and its cause, if it lasts: cleared or switched off and on before, the alarm comes again at once
// (manual 6.1, 9.6.8).

#include <cstdint>
#include <utility>
#include <vector>

#include "axes/port/drive_profile.hpp"

namespace taktwerk::axes::sim::xp200 {

class AlarmState {
public:
    explicit AlarmState(const DriveProfile& profile) {
        for (const auto& alarm : profile.alarms) clearable_.emplace_back(alarm.code, alarm.resettable);
    }
    [[nodiscard]] std::uint16_t code() const noexcept { return code_; }
    void power_on(bool torn_save) noexcept { code_ = torn_save ? 20 : cause_; }
    void power_off() noexcept { code_ = 0; }
    /// 0: it lasts no longer.
    void cause(std::uint16_t alarm) noexcept { cause_ = alarm; }
    /// False: another one is shown already.
    bool take(std::uint16_t alarm) noexcept {
        if (code_ != 0) return false;
        code_ = alarm;
        return true;
    }
    /// False: it stays.
    bool clear() noexcept {
        if (code_ == cause_) return false;
        for (const auto& [code, clearable] : clearable_)
            if (code == code_ && !clearable) return false;
        code_ = 0;
        return true;
    }

private:
    std::vector<std::pair<std::uint16_t, bool>> clearable_;  // alarm, by 9.6.8
    std::uint16_t code_ = 0, cause_ = 0;
};

}  // namespace taktwerk::axes::sim::xp200
