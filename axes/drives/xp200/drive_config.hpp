#pragma once
// One XP200 on a line as configured. Plain data.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::xp200 {

/// What a register bit of a terminal reads while it conducts, which is ON in positive logic. The manual says both (9.5, 4.2.1).
enum class ConductingReads : std::uint8_t { zero, one };

/// A parameter that the drive shall have. Written when the line comes up (memory only, never the EEPROM) where a write counts at once; else
/// compared, and the drive is not enabled with another value.
struct ParameterSetting {
    std::uint16_t number = 0;
    std::int64_t value = 0;
};

struct DriveConfig {
    std::string name;
    std::uint8_t station = 1;
    std::shared_ptr<const DriveProfile> profile;
    std::vector<ParameterSetting> parameters;
    ConductingReads inputs = ConductingReads::zero, outputs = ConductingReads::zero;
    std::int64_t counts_per_turn = 10000;  ///< of the axis; compared with Pr082
    bool has_watchdog_output = false;      ///< an output of the machine holds an input with function -15 (EMG, open = stop)
    /// Without an answer for so long the line is silent: the axis stops in error, the watchdog output drops.
    Duration silence = std::chrono::milliseconds{300};
};

}  // namespace taktwerk::axes::xp200
