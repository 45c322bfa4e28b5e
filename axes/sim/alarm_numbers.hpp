#pragma once
// The alarms of a drive by their number, and the object that tells those of one number apart (DriveProfile::alarm_detail_index; SV33-E P21.08).

#include <cstdint>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/axis_objects.hpp"
#include "axes/sim/drive_alarm_codes.hpp"
#include "axes/sim/set_if_there.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

class AlarmNumbers {
public:
    explicit AlarmNumbers(const DriveProfile& profile)
        : index_(profile.alarm_detail_index), sub_(profile.alarm_detail_sub), alarms_(profile.alarms) {}

    void power_on(ecat::sim::ObjectDictionary& dictionary) { entry_ = index_ ? dictionary.find(index_, sub_) : nullptr; }
    /// Shows the detail of the alarm that `out` has, and says it. Of a code without one it is the first row's. Real-time safe.
    std::int64_t show(const AxisOutputs& out) const noexcept {
        const std::int64_t detail = out.error_code != 0 && out.error_detail == 0 ? alarm(out.error_code).detail : out.error_detail;
        set_if_there(entry_, detail);
        return detail;
    }
    /// What the profile says of an alarm by its number; a number that it does not know stands for itself.
    [[nodiscard]] AlarmCode alarm(std::uint16_t code) const noexcept {
        if (code == 0) return {};
        for (const auto& row : alarms_)
            if (row.code == code) return alarm_code(row);
        return {code};
    }

private:
    std::uint16_t index_;
    std::uint8_t sub_;
    std::vector<DriveAlarmText> alarms_;
    ecat::sim::Entry* entry_ = nullptr;
};

}  // namespace taktwerk::axes::sim
