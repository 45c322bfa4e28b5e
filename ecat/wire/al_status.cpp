#include "ecat/wire/al_status.hpp"

#include <algorithm>
#include <array>

namespace taktwerk::ecat {

namespace {

constexpr auto table = std::to_array<AlStatusInfo>({
    {0x0000, "no error", ""},
    {0x0001, "unspecified error", "read the drive's own alarm (603Fh) and its display"},
    {0x0002, "no memory", "the slave has no memory for this configuration: map fewer objects"},
    {0x0003, "invalid device setup", "modules or options do not fit together: check the device's hardware set-up"},
    {0x0004, "invalid revision", "the slave's hardware or output revision does not match its firmware"},
    {0x0006, "SII and firmware do not match", "the EEPROM belongs to another firmware: update one of them with the vendor's tool"},
    {0x0007, "firmware update not successful", "repeat the firmware update"},
    {0x000E, "license error", "the slave lacks a licence for this function"},
    {0x0011, "invalid requested state change", "the requested state cannot follow the present one: go down to INIT and up again"},
    {0x0012, "unknown requested state", "the slave does not know this state"},
    {0x0013, "bootstrap not supported", "use the normal states for this device"},
    {0x0014, "no valid firmware", "the slave waits for a firmware update"},
    {0x0015, "invalid mailbox configuration (BOOT)", "SM0/SM1 differ from the bootstrap mailbox in the SII"},
    {0x0016, "invalid mailbox configuration (PREOP)",
     "SM0/SM1 differ from the slave's mailbox: check start, size and control against SII or ESI"},
    {0x0017, "invalid sync manager configuration",
     "a sync manager's start, size or control does not fit: compare with the slave's mapping"},
    {0x0018, "no valid inputs available", "the slave has no valid input data yet: check its sensors and supply"},
    {0x0019, "no valid outputs", "outputs did not arrive before OP: the process data must run while OP is requested"},
    {0x001A, "synchronization error", "SYNC0 and the frames do not keep step: check cycle time, SYNC0 shift and the sender's jitter"},
    {0x001B, "sync manager watchdog",
     "no valid outputs within the watchdog time: the master stopped, frames were lost, or the watchdog is too short for this cycle"},
    {0x001C, "invalid sync manager types", "the sync manager types in 1C00h differ from what was configured"},
    {0x001D, "invalid output configuration",
     "length of SM2 differs from the mapped outputs: compare 1C12h and its mapping with what was written; the drive may have kept its "
     "default"},
    {0x001E, "invalid input configuration",
     "length of SM3 differs from the mapped inputs: compare 1C13h and its mapping with what was written; the drive may have kept its "
     "default"},
    {0x001F, "invalid watchdog configuration", "check 0400h, 0410h, 0420h and the watchdog bit of the output sync manager"},
    {0x0020, "slave needs cold start", "switch the slave's control supply off and on"},
    {0x0021, "slave needs INIT", "take the slave to INIT and start again"},
    {0x0022, "slave needs PREOP", "take the slave to PREOP and configure it again"},
    {0x0023, "slave needs SAFEOP", "take the slave to SAFEOP and request OP again"},
    {0x0024, "invalid input mapping", "an object in a TxPDO cannot be mapped, or the PDO is too long"},
    {0x0025, "invalid output mapping", "an object in an RxPDO cannot be mapped, or the PDO is too long"},
    {0x0026, "inconsistent settings", "two settings contradict each other: check the start-up list"},
    {0x0027, "free run not supported", "run the slave with distributed clocks or SM synchronous"},
    {0x0028, "synchronization mode not supported", "check 1C32h:01 and 1C33h:01 against the manual"},
    {0x0029, "free run needs 3-buffer mode", "use buffered sync managers (control 64h and 20h)"},
    {0x002A, "background watchdog", "the slave's own process hung"},
    {0x002B, "no valid inputs and outputs", "neither inputs nor outputs are valid: check the process data and the slave's supply"},
    {0x002C, "fatal synchronization error", "SYNC0 stopped or came at the wrong time: check distributed clocks and cables"},
    {0x002D, "no synchronization signal", "SYNC0 never came: it must be started before this state; check 0981h and the start time 0990h"},
    {0x002E, "invalid input FMMU configuration", "an input FMMU does not cover the input sync manager"},
    {0x0030, "invalid DC SYNC configuration", "check cycle time (09A0h), activation (0981h) and which modes the drive accepts"},
    {0x0031, "invalid DC latch configuration", "check the latch settings 09A8h"},
    {0x0032, "PLL error", "the drive could not lock to SYNC0: the sender's jitter is too large, or SYNC0 does not fit the cycle"},
    {0x0033, "DC sync input/output error", "several synchronization errors in a row: check cycle time and jitter"},
    {0x0034, "DC sync timeout", "several SYNC0 events were missed: check distributed clocks"},
    {0x0035, "invalid DC sync cycle time", "this drive does not accept the cycle time: see its list of multiples"},
    {0x0036, "invalid DC SYNC0 cycle time", "this drive does not accept the SYNC0 cycle: see its list of multiples"},
    {0x0037, "invalid DC SYNC1 cycle time", "this drive does not accept the SYNC1 cycle"},
    {0x0041, "mailbox error: AoE", "the slave could not handle an ADS message: another tool or its own configuration sent it"},
    {0x0042, "mailbox error: EoE", "the slave could not handle a piece of an Ethernet frame: end the bridge and start it again"},
    {0x0043, "mailbox error: CoE", "the slave could not handle a CoE message: check the start-up list"},
    {0x0044, "mailbox error: FoE", "the slave could not handle a file message: repeat the transfer from its beginning"},
    {0x0045, "mailbox error: SoE", "the slave could not handle an IDN: check the list of its vendor"},
    {0x004F, "mailbox error: VoE", "the slave could not handle a message of its vendor's own protocol: ask the vendor"},
    {0x0050, "EEPROM: no access", "the master must hand the EEPROM to the slave (0500h) before PREOP"},
    {0x0051, "EEPROM: error", "the slave's EEPROM is empty or damaged"},
    {0x0052, "external hardware not ready", "power stage or external device is not ready: check its supply"},
    {0x0060, "slave restarted locally", "the slave was restarted: the bring-up begins again"},
    {0x0061, "device identification updated", "the rotary switch or alias changed"},
    {0x0070, "detected modules do not match", "configured and plugged modules differ"},
    {0x0080, "supply voltage too low", "check the supply"},
    {0x0081, "supply voltage too high", "check the supply"},
    {0x0082, "temperature too low", "wait until the device is warm"},
    {0x0083, "temperature too high", "check load and ventilation"},
    {0x00F0, "application controller available", "no error: the slave's processor has started; ask for the state again"},
});

constexpr bool ascending() {
    for (std::size_t i = 1; i < table.size(); ++i)
        if (table[i - 1].code >= table[i].code) return false;
    return true;
}
static_assert(ascending(), "al_status_info() searches by bisection");

constexpr AlStatusInfo unlisted{0xFFFF, "code not in the standard's table", "vendor code: look it up in the device's manual"};

}  // namespace

std::string_view name(AlState state) noexcept {
    switch (state) {
        case AlState::unknown: break;
        case AlState::init: return "INIT";
        case AlState::preop: return "PREOP";
        case AlState::boot: return "BOOT";
        case AlState::safeop: return "SAFEOP";
        case AlState::op: return "OP";
    }
    return "unknown";
}

std::span<const AlStatusInfo> al_status_codes() noexcept { return table; }

const AlStatusInfo& al_status_info(std::uint16_t code) noexcept {
    const auto* found =
        std::lower_bound(table.begin(), table.end(), code, [](const AlStatusInfo& info, std::uint16_t c) { return info.code < c; });
    return found != table.end() && found->code == code ? *found : unlisted;
}

}  // namespace taktwerk::ecat
