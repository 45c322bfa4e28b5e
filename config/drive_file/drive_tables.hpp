#pragma once
// The keys of a drive file (config/drives/*.yaml), and what is read from one before it becomes the two structs.

#include <string>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "config/drive_file/device_tables.hpp"
#include "config/drive_file/startup_entry.hpp"
#include "ecat/description/device_description.hpp"

namespace taktwerk::config {

/// A PDO that the runtime wants; no objects = the PDO's own mapping.
struct PdoChoice {
    ObjectAddress pdo;
    std::vector<ecat::PdoEntry> objects, required;
};

/// What speaks to a drive on a serial line.
enum class SerialCarrier : std::uint8_t { none, xp200_modbus };

struct DriveFile {
    SerialCarrier carrier = SerialCarrier::none;
    std::int64_t version = 0;
    ecat::DeviceDescription device;
    axes::DriveProfile profile;
    std::vector<PdoChoice> rx, tx;
    std::vector<StartupEntry> startup;
    std::vector<ObjectRow> objects;
    std::string module;  ///< for every slot of a modular drive
    std::string alarm_file, object_file;
    std::string based_on;         ///< already merged when the tables read
    std::string source, checked;  ///< where its facts come from, and against what they were checked; empty: the manual that its head names
};

struct ObjectFile {
    std::int64_t version = 0;
    std::vector<ObjectRow> objects;
};

struct AlarmFile {
    std::int64_t version = 0;
    std::vector<axes::DriveAlarmText> alarms;
};

inline constexpr std::int64_t format_version = 1;

/// Every file begins with it; another number is an error.
template <class T>
Field<T> version_field(std::int64_t T::*member);

[[nodiscard]] Table<DriveFile> drive_table();
/// For files with `carried_by`.
[[nodiscard]] Table<DriveFile> serial_drive_table();
[[nodiscard]] Table<AlarmFile> alarm_table();
[[nodiscard]] Table<ObjectFile> object_file_table();
/// Gives the rows to the dictionary and to the list of parameters.
void add_objects(DriveFile& file, const std::vector<ObjectRow>& rows);
[[nodiscard]] Codec<std::int64_t> version_number();

template <class T>
Field<T> version_field(std::int64_t T::*member) {
    return required(field("version", member, version_number(), "of this file's format: 1"));
}

}  // namespace taktwerk::config
