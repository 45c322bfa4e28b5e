#pragma once
// The keys of a device file (config/devices/*.yaml), and what is read from one.

#include <optional>
#include <string>
#include <vector>

#include "config/drive_file/device_tables.hpp"
#include "config/drive_file/startup_entry.hpp"
#include "config/reading/measure.hpp"

namespace taktwerk::config {

struct DevicePdo {
    ecat::PdoDescription pdo;
    bool assigned = true;  ///< as the device comes from the factory
};

/// Without a direction it was not said whether it is an input or an output: a problem was reported.
struct ChannelRow {
    std::string name;
    std::optional<ObjectAddress> input, output, error, underrange, overrange;
    std::optional<ecat::DataType> type;
    std::optional<MeasurePair> counts, value, range;
    std::string doc;
};

/// Channels by name.
struct EncoderLatchRow {
    std::string arm, latched;
};
struct EncoderRow {
    std::string position, valid, latch;
    std::optional<EncoderLatchRow> index, rising, falling;
    bool incremental = false;
};

struct DeviceFile {
    std::int64_t version = 0;
    std::string name, vendor, title, source, checked;
    ecat::DeviceDescription device;
    std::vector<DevicePdo> rx, tx;
    std::vector<ObjectRow> objects;
    std::vector<StartupEntry> startup;
    std::vector<ChannelRow> channels;
    std::vector<EncoderRow> encoders;
};

[[nodiscard]] Table<DeviceFile> device_file_table();

}  // namespace taktwerk::config
