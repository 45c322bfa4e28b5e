#pragma once
// A drive's own alarm in words: which drive, what its panel shows, its name in both languages, cause, remedy, and whether MC_Reset can
// clear it. Made outside the cycle from the drive's profile.

#include <cstdint>

#include "runtime/machine.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// What an axis tells of its drive's alarm.
struct ReportedAlarm {
    std::uint16_t code = 0;    ///< 603Fh or the drive's own number
    std::uint32_t detail = 0;  ///< 0: not read, or none
    enum class Kind : std::uint8_t { fault, warning } kind = Kind::fault;
};

/// Words of the row that fits code and detail; where no row has the detail, those of the code. A code that the profile does not list
/// keeps cause and remedy of `text`. Leaves the source, the name and the reaction alone.
void tell_drive_alarm(AlarmText& text, const AxisBinding& axis, const ReportedAlarm& alarm);

}  // namespace taktwerk::runtime
