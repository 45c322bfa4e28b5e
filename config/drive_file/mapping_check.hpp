#pragma once
// What a drive file maps into its PDOs, against its dictionary and the drive's own limits.

#include <string>
#include <string_view>
#include <vector>

#include "config/drive_file/drive_tables.hpp"
#include "config/reading/reader.hpp"
#include "ecat/description/device_description.hpp"

namespace taktwerk::config {

/// Fills in the bits of all mapped objects. Problems (config.mapping): objects that the dictionary lacks or that may not be mapped,
/// PDOs that are not available, more than the drive takes.
void check_mapping(Reader& reader, DriveFile& file);

}  // namespace taktwerk::config
