#pragma once
// What the master is told about one bus. Plain data, checked by `check(BusConfig)`; config/ only fills it.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/device_description.hpp"

namespace taktwerk::ecat {

/// AL state transitions at which start-up SDOs are written.
enum class Transition : std::uint8_t { PreopToSafeop, SafeopToOp };

/// One SDO written during bring-up.
struct StartupSdo {
    Transition at = Transition::PreopToSafeop;
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    DataType type = DataType::U32;
    std::int64_t value = 0;
    bool verify = true;       ///< read back and compare; set false for write-only objects
    bool if_changed = false;  ///< read first, write only a different value (spares the EEPROM)
    std::string origin;       ///< where it was asked for ("demo.yaml:31:7", "homing of axis x"), for messages
};

/// PDO selection of one direction; empty `assigned` keeps the slave's own default.
struct PdoSelection {
    std::vector<PdoDescription> assigned;  ///< written to 16xxh/1Axxh (unless fixed) and 1C12h/1C13h
};

struct SlaveConfig {
    std::string name;
    std::shared_ptr<const DeviceDescription> device;
    std::optional<std::uint16_t> position;  ///< 0-based on the cable; exactly one of position and alias
    std::optional<std::uint16_t> alias;
    PdoSelection rx, tx;
    std::vector<StartupSdo> startup;
    bool dc = false;         ///< run SYNC0 on it
    Duration sync0_shift{};  ///< SYNC0 after the start of the bus cycle; 0 = the master's default
    Duration sm_watchdog{};  ///< 0 = three cycles, at least 10 ms
    std::string sync_unit;   ///< slaves of the same name share one datagram and working counter; empty: its own
};

struct BusConfig {
    std::string interface;  ///< NIC; empty: simulated
    Duration cycle = std::chrono::milliseconds{1};
    Duration sync0_shift{};               ///< default shift; 0 = half a cycle
    std::vector<SlaveConfig> slaves;      ///< in any order
    std::uint16_t lost_frames_limit = 3;  ///< consecutive unanswered cycles until the bus alarm
    std::uint8_t acyclic_per_cycle = 4;   ///< datagrams per cycle for SDO, recovery, diagnosis
};

/// Every problem of a configuration, found without a bus.
[[nodiscard]] std::vector<Error> check(const BusConfig& config);

}  // namespace taktwerk::ecat
