#pragma once
// What a slave type is: identity, mailbox, sync managers, PDOs, dictionary, DC. One description serves the master (what it
// expects and configures) and the simulator (what it plays). Filled from drive and device files by config/, which makes
// them of vendors' ESI, too. Plain data; not real-time.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "ecat/wire/identity.hpp"

namespace taktwerk::ecat {

/// CoE basic data types (ETG.1000.6); `bits` of an object follows from it.
enum class DataType : std::uint8_t { BOOL, I8, I16, I32, I64, U8, U16, U32, U64, REAL32, REAL64, STRING };
[[nodiscard]] constexpr std::uint8_t bit_size(DataType type) noexcept {  ///< STRING: 0
    switch (type) {
        case DataType::BOOL: return 1;
        case DataType::I8:
        case DataType::U8: return 8;
        case DataType::I16:
        case DataType::U16: return 16;
        case DataType::I32:
        case DataType::U32:
        case DataType::REAL32: return 32;
        case DataType::I64:
        case DataType::U64:
        case DataType::REAL64: return 64;
        case DataType::STRING: break;
    }
    return 0;
}
[[nodiscard]] constexpr bool is_signed(DataType type) noexcept {
    return type == DataType::I8 || type == DataType::I16 || type == DataType::I32 || type == DataType::I64;
}

enum class Access : std::uint8_t { ro, rw, wo };
enum class Mappable : std::uint8_t { no, rx, tx, both };

struct ObjectEntry {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    std::string name;
    DataType type = DataType::U32;
    Access access = Access::rw;
    Mappable mappable = Mappable::no;
    std::int64_t value = 0;  ///< default
    std::optional<std::int64_t> minimum, maximum;
    std::string text;  ///< default of a STRING
};

/// index 0 = a gap of `bits`.
struct PdoEntry {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    std::uint8_t bits = 0;
    friend bool operator==(const PdoEntry&, const PdoEntry&) = default;
};

struct PdoDescription {
    std::uint16_t index = 0;                     ///< 16xxh/17xxh Rx, 1Axxh/1Bxxh Tx
    bool fixed = false;                          ///< its entries cannot be changed
    std::vector<PdoEntry> entries;               ///< default mapping
    std::optional<std::uint8_t> sync_manager{};  ///< the one it is assigned to; none: the first of its direction
};

enum class SmUse : std::uint8_t { mailbox_out, mailbox_in, outputs, inputs };

struct SyncManagerDescription {
    SmUse use = SmUse::outputs;
    std::uint16_t start = 0;
    std::uint16_t size = 0;    ///< mailboxes and slaves without CoE; process data of a CoE slave: computed from the PDOs
    std::uint8_t control = 0;  ///< usual: 26h mailbox out, 22h mailbox in, 64h outputs (watchdog), 20h inputs
};

struct DcDescription {
    bool supported = false;
    bool required = false;  ///< SYNC0 must run before SAFEOP (SV33-E: DC SYNC0 only, sheet 1.3)
    bool clock_64bit = true;
    Duration minimum_cycle{};        ///< 0 = not stated
    Duration cycle_multiple{};       ///< the cycle must be a multiple of it; 0 = any
    std::vector<Duration> cycles{};  ///< the only cycles that the slave knows; empty = any
};

/// The mailboxes in BOOT (SII words 14h to 17h); their sync managers are those of the others.
struct BootstrapDescription {
    std::uint16_t out_start = 0, out_size = 0;  ///< master -> slave
    std::uint16_t in_start = 0, in_size = 0;
};

struct MailboxDescription {
    bool coe = true;
    bool complete_access = false;
    bool sdo_info = false;
    std::uint8_t max_pending = 4;                     ///< messages the slave buffers (SV33-E manual 6.2.8.4)
    bool foe = false;                                 ///< files
    bool eoe = false;                                 ///< Ethernet
    std::optional<BootstrapDescription> bootstrap{};  ///< none: the slave has no BOOT
};

/// Per direction, what CoE lets the master assign and map.
struct PdoRules {
    std::uint8_t max_assigned = 1;  ///< 1C12h:00 / 1C13h:00
    std::uint8_t max_entries = 10;  ///< entries per mapping object
    std::uint16_t max_bytes = 1486;
    bool assignment_fixed = false;  ///< 1C12h or 1C13h can be read alone
};

/// How exactly the revision of SII word Ch has to be the description's.
enum class RevisionRule : std::uint8_t {
    any,
    at_least,  ///< the number is the description's or a greater one
    exact,
};

/// One valid content of a slot (ETG.5001). Its PDOs are those of slot 0; each further slot adds SlotDescription's increments.
struct ModuleDescription {
    std::string name;         ///< how a configuration chooses it
    std::uint32_t ident = 0;  ///< written to F030h, found in F050h; 0: not known, neither is looked at
    std::vector<PdoDescription> rx_pdos, tx_pdos;
};

/// The slots of a modular slave.
struct SlotDescription {
    std::uint8_t count = 0;             ///< 0: not modular
    std::uint16_t index_increment = 0;  ///< 800h: object 6040h of slot 2 is 7040h
    std::uint16_t pdo_increment = 0;    ///< 40h: 1600h of slot 2 is 1680h
    bool may_be_empty = false;          ///< a slot may hold no module: input and output boxes. Not so: each axis of TSVM-D6 wants one
    std::vector<ModuleDescription> modules;
};

/// The module plugged into (or chosen for) a slot of a modular slave.
struct ModuleSelection {
    std::uint8_t slot = 0;  ///< 0-based
    std::string module;     ///< name of a ModuleDescription of the device
};

/// What of a description somebody stated of this very device. The rest is what devices of its kind mostly have: the simulator plays it, and
/// on a bus the slave's own word goes before it (ecat/bringup/own_word.hpp, pdo_search.hpp).
struct StatedParts {
    bool identity = true;      ///< false: whoever stands in the place is taken
    bool controller = true;    ///< mailbox and sync managers; false: those of the EEPROM
    bool process_data = true;  ///< false: what the slave lets itself be given, else what it has
};

struct DeviceDescription {
    std::string name;                     ///< "sv33-e"
    std::string device_name;              ///< 1008h
    Identity identity;                    ///< vendor and product are compared exactly
    std::vector<Identity> also_accepted;  ///< manuals contradict themselves: further vendor/product pairs
    RevisionRule revision_rule = RevisionRule::any;
    std::optional<MailboxDescription> mailbox;          ///< none: a plain terminal, configured from SII alone
    std::vector<SyncManagerDescription> sync_managers;  ///< in SM order
    std::vector<PdoDescription> rx_pdos, tx_pdos;
    std::vector<std::uint16_t> rx_assigned, tx_assigned;  ///< factory 1C12h / 1C13h
    PdoRules rx_rules, tx_rules;
    std::vector<ObjectEntry> objects;  ///< without 1018h, 16xxh.., 1C00h..: those follow from the fields above
    DcDescription dc;
    SlotDescription slots;
    StatedParts stated;
    std::uint8_t fmmus = 8, sync_manager_count = 8;
    std::uint16_t process_ram = 0x1000;          ///< bytes from 1000h
    std::optional<std::int16_t> ebus_current{};  ///< mA that it takes from the E-bus; negative: it supplies so much; none: not known
};

}  // namespace taktwerk::ecat
