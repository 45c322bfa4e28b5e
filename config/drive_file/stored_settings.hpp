#pragma once
// What stands in a drive's EEPROM (`stored:` of a slave), and start-up entries that cannot work because the drive looks at such an object
// when it is switched on only.

#include <cstddef>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "config/drive_file/startup_entry.hpp"

namespace taktwerk::config {

/// One line of `stored:` as written.
struct StoredEntry {
    ObjectAddress object;
    std::int64_t value = 0;
    std::string comment;
    Position where;
};
[[nodiscard]] Table<StoredEntry> stored_table();

/// An object of a slave as its drive file lists it.
struct DriveObject {
    std::size_t axis = 0;                             ///< of a drive with several, from 0
    axes::ParameterAddress object;                    ///< as of the first axis
    const axes::DriveParameter* parameter = nullptr;  ///< null: the drive file does not list it
};
/// Of a drive with several axes the objects of each stand `object_offset` higher.
[[nodiscard]] DriveObject find_drive_object(const axes::DriveProfile& profile, const ObjectAddress& at);

/// A setting and the axis of the drive (from 0) that it belongs to.
struct AxisStored {
    std::size_t axis = 0;
    axes::StoredSetting setting;
};
/// Reports what the drive does not have, what it cannot keep, what stands there twice, and what a start-up list writes as well, the machine's
/// or that of the drive's file (config.stored_*).
[[nodiscard]] std::vector<AxisStored> resolve_stored(Reader& reader, const std::string& slave, const std::vector<StoredEntry>& entries,
                                                     const std::vector<ecat::StartupSdo>& startup, const axes::DriveProfile& profile);

/// A value that is written while the drive comes up and counts after a restart only is not in force when the axis is enabled: reports the
/// entry with the way that works (config.startup_too_late).
void refuse_late_startup(Reader& reader, const std::string& slave, const std::vector<StartupEntry>& entries,
                         const axes::DriveProfile& profile);

}  // namespace taktwerk::config
