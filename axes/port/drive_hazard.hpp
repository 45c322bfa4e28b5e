#pragma once
// What is dangerous about a drive in a machine that forgot something, from the manual's own words. A row names a condition that
// code evaluates against the machine's configuration; the sentence and the remedy are the drive's. Plain data.

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "axes/port/drive_port.hpp"

namespace taktwerk::axes {

enum class HazardCondition : std::uint8_t {
    always,              ///< worth a warning in every machine with this drive
    not_written,         ///< one of `objects` is neither written by a start-up list nor sent cyclically: the factory value holds
    not_set_to,          ///< the effective value of an object (start-up list, stored, else factory) is none of `values`, or unknown
    set_to,              ///< the effective value of an object is one of `values`
    mapped,              ///< one of `objects` is in the process data
    not_mapped,          ///< one of `objects` is not in the process data
    mode_mapped,         ///< the target object of `mode` is in the process data, so that programs can use the mode
    homed_by_drive,      ///< the axis is homed by the drive
    no_software_limits,  ///< the axis has a finite travel nowhere: no software limits
    absolute_homing,     ///< the axis trusts the absolute encoder
};

struct DriveHazard {
    HazardCondition when = HazardCondition::always;
    std::vector<ParameterAddress> objects{};
    std::vector<std::int64_t> values{};
    DriveMode mode = DriveMode::none;
    std::string text{};     ///< what happens, one sentence
    std::string remedy{};   ///< what to write or wire
    std::string section{};  ///< of the manual
};

struct DriveProfile;

/// What a machine does with one drive axis, as far as hazards ask. Addresses as for the first axis of the drive.
struct DriveUse {
    struct Written {
        ParameterAddress address;
        std::int64_t value = 0;
    };
    std::vector<Written> written;                  ///< by start-up lists, in their order
    std::vector<ParameterAddress> sent, received;  ///< process data
    bool homed_by_drive = false, absolute_homing = false, software_limits = false;
};

/// The hazards of the profile that apply, in its order. Not real-time.
[[nodiscard]] std::vector<const DriveHazard*> hazards_of(const DriveProfile& profile, const DriveUse& use);

}  // namespace taktwerk::axes
