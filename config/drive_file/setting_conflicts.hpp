#pragma once
// Settings of a drive in a machine file that cannot work, found before anything is started: commands that a start-up list would give at each
// start, and values in the EEPROM or the start-up list with which the drive would be refused when it comes up.

#include <cstdint>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "config/drive_file/startup_entry.hpp"
#include "config/drive_file/stored_settings.hpp"

namespace taktwerk::config {

/// A list is written at each start, whoever stands there: reports entries that do something instead of setting it: save, restore, clear turns
/// (config.startup_command). `profile`: null where the slave is no drive; then by what CiA 301 says of 1010h and 1011h.
void refuse_startup_commands(Reader& reader, const std::string& slave, const std::vector<StartupEntry>& entries,
                             const axes::DriveProfile* profile);

/// One axis that is on a drive: what it is held up to.
struct DriveAxis {
    std::string name;
    std::size_t axis = 0;  ///< of the drive, from 0
    std::int64_t counts_per_revolution = 0;
    Duration cycle{};
    bool clocks = false;  ///< the slave runs on SYNC0
};
/// Reports what `stored` and `startup` of the machine file say and the runtime would refuse when it reads it: another scale than the
/// gearing's, a required setting with another value (config.setting_contradicts).
void refuse_contradictions(Reader& reader, const std::string& slave, const std::vector<StoredEntry>& stored,
                           const std::vector<StartupEntry>& startup, const axes::DriveProfile& profile, const DriveAxis& axis);

}  // namespace taktwerk::config
