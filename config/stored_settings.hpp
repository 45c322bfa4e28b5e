#pragma once
// What stands in a drive's EEPROM (`stored:` of a slave), and start-up entries that cannot work because the drive looks at such an object
// when it is switched on only.

#include <cstddef>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "config/startup_entry.hpp"

namespace taktwerk::config {

/// One line of `stored:` as written.
struct StoredEntry {
    ObjectAddress object;
    std::int64_t value = 0;
    std::string comment;
    Position where;
};
[[nodiscard]] Table<StoredEntry> stored_table();

/// A setting and the axis of the drive (from 0) that it belongs to.
struct AxisStored {
    std::size_t axis = 0;
    axes::StoredSetting setting;
};
/// Reports what the drive does not have, what it cannot keep, and what `startup` writes as well (config.stored_*).
[[nodiscard]] std::vector<AxisStored> resolve_stored(Reader& reader, const std::string& slave, const std::vector<StoredEntry>& entries,
                                                     const std::vector<StartupEntry>& startup, const axes::DriveProfile& profile);

/// A value that is written while the drive comes up and counts after a restart only is not in force when the axis is enabled: reports the
/// entry with the way that works (config.startup_too_late).
void refuse_late_startup(Reader& reader, const std::string& slave, const std::vector<StartupEntry>& entries,
                         const axes::DriveProfile& profile);

}  // namespace taktwerk::config
