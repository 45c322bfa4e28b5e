#pragma once
// The keys of a drive file that say what the slave is on the bus: identity, mailbox, sync managers, PDOs, objects, clock. They
// fill ecat::DeviceDescription, for master and simulator alike.

#include <vector>

#include "axes/port/drive_parameter.hpp"
#include "config/reading/field_table.hpp"
#include "ecat/description/device_description.hpp"

namespace taktwerk::config {

[[nodiscard]] std::vector<Field<ecat::DeviceDescription>> device_fields();
/// Those that say nothing of process data, none of them required but `identity`: a coupler has no sync manager.
[[nodiscard]] std::vector<Field<ecat::DeviceDescription>> controller_fields();
/// One PDO of a slave.
[[nodiscard]] Table<ecat::PdoDescription> pdo_table();

/// One row of `objects`: what bus and simulator need of it, and what people do.
struct ObjectRow {
    ecat::ObjectEntry object;
    axes::DriveParameter parameter;
    bool is_register = false;  ///< not an object: belongs to a drive without a dictionary
    bool has_value = false, has_commissioned = false;
    [[nodiscard]] bool is_object() const noexcept { return !is_register && parameter.reach == axes::ParameterReach::bus; }
};
[[nodiscard]] Table<ObjectRow> object_table();

/// An object in a PDO; its bits are looked up later unless given.
[[nodiscard]] Codec<ecat::PdoEntry> pdo_entry();
[[nodiscard]] Codec<ecat::RevisionRule> revision_rule();
/// How far a file's facts are to be trusted.
[[nodiscard]] Codec<std::string> checked_against();
inline constexpr const char* checked_doc =
    "against what: read from a real unit · the vendor's ESI · what one project configured · inferred, see `source`";

}  // namespace taktwerk::config
