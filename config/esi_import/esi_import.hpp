#pragma once
// A vendor's device as a device file of ours, and all that such a file cannot hold. Not real-time.

#include <string>
#include <vector>

#include "config/device_file/device_file_tables.hpp"
#include "core/result.hpp"
#include "ecat/esi/esi_file.hpp"

namespace taktwerk::config {

/// One thing that the vendor says and the file does not.
struct Leftover {
    std::string what;     ///< "init command 8010h in one piece"
    std::string meaning;  ///< what follows from it, and what to do; may be empty
};

struct EsiImport {
    DeviceFile file;
    std::vector<Leftover> leftovers;
};

/// `source`: the file's name, for `source:`. `name`: of the device here; empty: made of its type. Errors: esi.unusable (the first of the
/// reading's problems, or process data that no device file can hold), esi.no_product, esi.name.
[[nodiscard]] Result<EsiImport> import_device(const ecat::esi::EsiReading& reading, const std::string& vendor, const std::string& source,
                                              const std::string& name);

/// "EL3104-0020" -> "el3104-0020": letters, digits, `_` and `-`, a letter first, at most 40.
[[nodiscard]] std::string device_file_name(const std::string& type);

}  // namespace taktwerk::config
