#pragma once
// What a slave exchanges, and where it lies: sync managers and FMMUs as programmed, the PDOs assigned to them, each entry with
// its offset, and in SAFEOP and OP its present value. Reads only (a slave with CoE must be in PREOP or above).

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ecat/bringup/bus.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

struct PdoEntryReport {
    std::uint16_t index = 0;  ///< 0: a gap
    std::uint8_t sub = 0, bits = 0;
    std::uint32_t bit_offset = 0;  ///< from the start of its sync manager
    std::string name;              ///< from description or EEPROM; may be empty
    std::uint16_t type = 0;        ///< CoE type number; 0 unknown
    std::optional<std::vector<std::byte>> value;
};
struct PdoMapReport {
    std::uint16_t index = 0;
    std::vector<PdoEntryReport> entries;
};
struct SyncManagerReport {
    std::uint8_t number = 0;
    SyncManager registers;  ///< as read from the slave
    std::optional<SmUse> use;
    std::vector<PdoMapReport> pdos;
    std::uint32_t mapped_bytes = 0;  ///< what the PDOs need; the register says what the slave checks
};
struct PdoReport {
    std::string subject;
    std::uint16_t position = 0;
    AlState state = AlState::unknown;
    std::vector<SyncManagerReport> sync_managers;  ///< those in use
    std::vector<std::pair<unsigned, Fmmu>> fmmus;  ///< those that are active
    std::optional<Error> error;                    ///< what is above is then as far as it got
};

/// `slave`: adopted or brought up; its mailbox is open if it has one.
[[nodiscard]] Script<Result<PdoReport>> read_pdos(Bus& bus, BusSlave& slave);

/// Sync managers and FMMUs as the slave's controller has them now, all that its controller counts.
struct ControllerTables {
    std::vector<SyncManager> sync_managers;
    std::vector<Fmmu> fmmus;
};
[[nodiscard]] Script<Result<ControllerTables>> read_tables(Bus& bus, BusSlave& slave);

}  // namespace taktwerk::ecat
