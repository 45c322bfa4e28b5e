#pragma once
// The alarms that a simulated drive finds out by itself: the number that this drive has for each kind, from its profile.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "axes/port/drive_profile.hpp"

namespace taktwerk::axes::sim {

struct AlarmCode {
    std::uint16_t code = 0;
    bool resettable = true;
    std::uint32_t detail = 0;  ///< what the detail object shows (P21.08)
    bool warning = false;      ///< the drive goes on
    bool whole_drive = false;  ///< stands in every axis, before the axis' own (TSVM 7.1)
};
[[nodiscard]] inline AlarmCode alarm_code(const DriveAlarmText& row) noexcept {
    return {row.code, row.resettable, row.detail, row.warning, row.whole_drive};
}

/// The profile's first alarm of this kind, as one of this axis that stops it; `otherwise` where it marks none.
[[nodiscard]] AlarmCode first_alarm(const DriveProfile& profile, DriveAlarmKind kind, const AlarmCode& otherwise) noexcept;

/// A way in which a drive fails at once, whatever it is doing. How it shows and whether it clears is the drive's.
enum class Failure : std::uint8_t { overspeed, following_error, undervoltage, overload, encoder, communication };

class DriveAlarmCodes {
public:
    /// The first row of a kind is the drive's own alarm for it; kinds that the profile does not mark keep the usual codes.
    explicit DriveAlarmCodes(const DriveProfile& profile);
    /// Code 0: this drive has no such alarm.
    [[nodiscard]] const AlarmCode& operator[](DriveAlarmKind kind) const noexcept { return codes_[static_cast<std::size_t>(kind)]; }

private:
    std::array<AlarmCode, std::numeric_limits<std::uint8_t>::max() + 1> codes_{};  ///< of every value that a kind can have
};

}  // namespace taktwerk::axes::sim
