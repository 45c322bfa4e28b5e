#pragma once
// The keys of a machine file that describe its bus: interface, slaves, what each gets. Names are resolved by the loader.

#include <optional>
#include <string>
#include <vector>

#include "config/startup_entry.hpp"
#include "config/stored_settings.hpp"
#include "ecat/bus_config.hpp"

namespace taktwerk::config {

struct MachineFile;

struct Terminal {
    std::uint8_t inputs = 0, outputs = 0;
};

struct SlaveEntry {
    std::string name, profile;
    std::optional<Terminal> terminal;
    std::optional<std::uint16_t> position, alias, device_id;
    std::optional<ecat::RevisionRule> revision_rule;
    ecat::LossPolicy on_loss = ecat::LossPolicy::stop_machine;
    std::optional<bool> dc;
    Duration sync0_shift{}, sm_watchdog{}, pdi_watchdog{};
    std::optional<Duration> sync1;
    ecat::SyncStart sync_start = ecat::SyncStart::before_safeop;
    std::string sync_unit;
    std::vector<ecat::ModuleSelection> modules;
    std::vector<ObjectAddress> rx, tx;
    std::vector<StartupEntry> startup;
    std::vector<StoredEntry> stored;
    bool broken = false;  ///< problems were reported: what follows from them is noise
};

/// The section `bus`.
[[nodiscard]] Field<MachineFile> bus_field();

}  // namespace taktwerk::config
