#pragma once
// The keys of a machine file that describe its bus: interface, slaves, what each gets. Names are resolved by the loader.

#include <optional>
#include <string>
#include <vector>

#include "axes/port/drive_port.hpp"
#include "config/drive_file/startup_entry.hpp"
#include "config/drive_file/stored_settings.hpp"
#include "ecat/bus_config.hpp"

namespace taktwerk::config {

struct MachineFile;

struct Terminal {
    std::uint8_t inputs = 0, outputs = 0;
};

/// One of `slaves`: what the bus is told as it is written, and beside it what the loader has to look up first.
struct SlaveEntry {
    ecat::SlaveConfig slave;  ///< without description, process data, start-up SDOs; `dc` follows from the one below
    std::string profile, device;
    std::optional<Terminal> terminal;
    std::optional<bool> dc;
    std::optional<ecat::Identity> identity;
    std::vector<axes::DriveMode> modes;
    std::vector<ObjectAddress> rx, tx;
    std::vector<StartupEntry> startup;
    std::vector<StoredEntry> stored;
    bool broken = false;  ///< problems were reported: what follows from them is noise
};

/// The section `bus`.
[[nodiscard]] Field<MachineFile> bus_field();

}  // namespace taktwerk::config
