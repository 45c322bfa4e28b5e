#pragma once
// From a point as it is written to one that the runtime reads: its channel found, its scale put together.

#include <vector>

#include "config/device_file/device_loader.hpp"
#include "config/machine_file/machine_tables.hpp"

namespace taktwerk::config {

/// The slave of a point, as far as it is known.
struct PointPlace {
    bool known = false;                                    ///< it is in the file, and nothing was wrong with it
    const LoadedDevice* device = nullptr;                  ///< nullptr: a drive
    const modbus::tcp::DeviceConfig* modbus = nullptr;     ///< no slave at all, but a Modbus device
    bool is_terminal = false;                              ///< of the shorthand `terminal`
    const ecat::DeviceDescription* description = nullptr;  ///< of any slave
};

/// Reports what does not fit: config.no_channel, config.channel_taken (against `others`), config.scale, config.unit_wrong.
[[nodiscard]] runtime::IoPoint make_point(Reader& reader, const IoEntry& entry, runtime::IoDirection direction, const PointPlace& place,
                                          const std::vector<runtime::IoPoint>& others);

}  // namespace taktwerk::config
