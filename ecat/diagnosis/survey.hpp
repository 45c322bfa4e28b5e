#pragma once
// Who is on the cable: every slave with address, identity, name, state, ports and error counters, and the tree they form.
// Reads only, with three exceptions, all only while no slave is in SAFEOP or OP: slaves without an address of their own get
// one, an EEPROM that an application holds is taken back, and slaves that say they have an explicit device id are asked for it
// (AL control bit 5). AL states, sync managers and counters stay as they are.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/bringup/bus.hpp"
#include "ecat/bringup/port_counters.hpp"
#include "ecat/bus_config.hpp"
#include "ecat/topology/topology.hpp"

namespace taktwerk::ecat {

/// What 0007h says about a port.
enum class PortKind : std::uint8_t { none = 0, not_configured = 1, ebus = 2, mii = 3 };
[[nodiscard]] std::string_view name(PortKind kind) noexcept;

struct SurveyedPort {
    PortKind kind = PortKind::none;
    bool link = false;  ///< signal at the connector
    bool open = false;  ///< frames go out there
    PortCounters counters;
    friend bool operator==(const SurveyedPort&, const SurveyedPort&) = default;
};

struct SurveyedSlave {
    FoundSlave found;
    AlState state = AlState::unknown;
    bool al_error = false;
    std::uint16_t al_code = 0;
    bool eeprom_with_pdi = false;  ///< its processor had the EEPROM (0500h) before the survey took it
    std::array<SurveyedPort, ports_per_slave> ports;
    std::uint8_t processing_unit_errors = 0, pdi_errors = 0;
    std::uint8_t sm_watchdogs = 0;    ///< 0442h: how often outputs stayed away
    std::string device_name;          ///< from its EEPROM; empty: says nothing
    std::string order_name;           ///< likewise: the type as it is ordered
    std::optional<int> ebus_current;  ///< mA it takes from the E-bus; negative: it supplies so much
    std::optional<int> ebus_left;     ///< mA left behind it; negative: too many terminals for this coupler

    [[nodiscard]] bool dc() const noexcept;
    [[nodiscard]] bool has_mailbox() const noexcept { return found.mailbox[1] != 0; }
    /// "CoE, FoE"; empty: no mailbox.
    [[nodiscard]] std::string protocols() const;

    // Filled by compare_with().
    std::string name;               ///< as configured; empty: nobody configured it
    std::string expected;           ///< the configured device
    std::optional<Error> mismatch;  ///< it is another one
};

struct Survey {
    std::vector<SurveyedSlave> slaves;  ///< by position
    std::optional<Topology> topology;
    RingState ring;                          ///< of two interfaces
    std::vector<Error> remarks;              ///< what is wrong with the bus as a whole: cables, a foreign master, configured slaves missing
    AlState highest_state = AlState::init;   ///< over all slaves
    std::vector<std::string> absent_groups;  ///< filled by compare_with(): those of the configuration that are not plugged in

    /// "slave 2 'y'": how a message names it.
    [[nodiscard]] std::string subject(std::size_t position) const;
};

/// What it may write.
enum class SurveyMay : std::uint8_t {
    give_addresses,  ///< station addresses (and who holds the EEPROM) of slaves below SAFEOP
    only_look,       ///< nothing at all: beside another master
    as_brought_up,   ///< nothing: who asks has brought the bus up, and the addresses are his, those of groups too
};

/// Errors: bus.no_frame, bus.empty. What is wrong with single slaves stands in their FoundSlave::error.
/// `ring`: of a bus with two interfaces, as the frames of the survey themselves show it.
[[nodiscard]] Script<Result<Survey>> survey(DatagramPort& port, SurveyMay may = SurveyMay::give_addresses, const SeenRing* ring = nullptr);

/// The explicit device ids, for configurations that address by them. Asks through AL control, which slaves take in any state.
[[nodiscard]] Script<Result<void>> read_device_ids(DatagramPort& port, Survey& survey);

/// Gives the slaves their configured names and notes who is missing, not expected, or another device. Pure.
void compare_with(const BusConfig& config, Survey& survey);

/// Of a bus with two interfaces: nothing while the ring is closed, else where it is broken, by both ends. Pure.
[[nodiscard]] std::optional<Error> ring_remark(const Survey& survey);

/// Error counters and links of one slave; false: it did not answer.
[[nodiscard]] Script<bool> read_counters(DatagramPort& port, SurveyedSlave& slave);

}  // namespace taktwerk::ecat
