#pragma once
// What the master is told about one bus. Plain data, checked by `check(BusConfig)`; config/ only fills it.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/bus_transport.hpp"
#include "ecat/description/device_description.hpp"

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
    bool if_there = false;    ///< a slave that has it not, or refuses the value, comes up all the same; a note says so
    std::string origin;       ///< where it was asked for ("demo.yaml:31:7", "homing of axis x"), for messages
};

/// PDO selection of one direction; empty `assigned` keeps the slave's own default.
struct PdoSelection {
    std::vector<PdoDescription> assigned;  ///< written to 16xxh/1Axxh (unless fixed) and 1C12h/1C13h
    /// Of a slave whose PDOs nobody stated: `assigned` is a wish, most important objects first, and of them it must have these. Empty:
    /// `assigned` holds as it stands.
    std::vector<PdoEntry> required{};
};

/// An object that the slave is asked for while it comes up, in PREOP and behind its start-up SDOs. See Master::told().
struct AskedObject {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
};

/// An object that goes out with the frames although nobody asked for it, and what the slave had in it before. See Master::found_outputs().
struct FoundOutput {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    std::uint32_t value = 0;  ///< its lowest 32 bits
};

/// What the loss of a slave means to the machine.
enum class LossPolicy : std::uint8_t {
    stop_machine,   ///< every axis stops
    stop_own_axes,  ///< only what is on this slave stops; the others run on
};

/// The AL state in which SYNC0/SYNC1 are started. Most drives want them before SAFEOP; some refuse them there.
enum class SyncStart : std::uint8_t { before_safeop, in_safeop };

struct SlaveConfig {
    std::string name;
    std::shared_ptr<const DeviceDescription> device;
    std::optional<std::uint16_t> position;      ///< 0-based on the cable, groups not counted; exactly one of position, alias and device_id
    std::optional<std::uint16_t> alias;         ///< station alias: register 0012h, loaded from SII word 4
    std::optional<std::uint16_t> device_id;     ///< explicit device identification (AL control bit 5)
    std::optional<RevisionRule> revision_rule;  ///< instead of the description's
    LossPolicy on_loss = LossPolicy::stop_machine;
    PdoSelection rx, tx;
    std::vector<ModuleSelection> modules;
    std::vector<StartupSdo> startup;
    std::vector<AskedObject> asked;
    bool dc = false;                ///< run SYNC0 on it
    Duration sync0_shift{};         ///< SYNC0 after the start of the bus cycle; 0 = the master's default
    std::optional<Duration> sync1;  ///< run SYNC1, this long after SYNC0 (0 .. below the cycle)
    SyncStart sync_start = SyncStart::before_safeop;
    Duration sm_watchdog{};   ///< 0 = three cycles of its sync unit, at least 10 ms
    Duration pdi_watchdog{};  ///< 0 = as the controller has it after power-on
    std::string sync_unit;    ///< slaves of the same name share one datagram and working counter; empty: its own
    /// The group that it comes and goes with; empty: it is always there. The first of a group, in the order of the list, has an alias or a
    /// device id; the others stand behind it on the cable, as they are listed, and have no place of their own.
    std::string hot_connect;
    [[nodiscard]] bool guest() const noexcept { return !hot_connect.empty(); }
};

/// Slaves that come and go together: a tool, a trailer. Wherever it is plugged in.
struct HotConnectGroup {
    std::string name;
    std::vector<std::size_t> slaves;  ///< in BusConfig::slaves, as they stand on the cable; the first is who the group is known by
};

/// A group of slaves that is exchanged together. Named by SlaveConfig::sync_unit; those that are not listed have divisor 1.
struct SyncUnitConfig {
    std::string name;
    std::uint16_t divisor = 1;  ///< exchanged every so many bus cycles
};

/// How long a slave may take for a transition, from writing AL control until AL status shows it. Defaults: ETG.1020 (INIT ->
/// PREOP 3 s, PREOP -> SAFEOP and SAFEOP -> OP 10 s, down 5 s).
struct StateTimeouts {
    Duration preop = std::chrono::seconds{3};
    Duration safeop = std::chrono::seconds{10};
    Duration op = std::chrono::seconds{10};
    Duration down = std::chrono::seconds{5};  ///< back towards INIT, and the acknowledgement of an error
};

/// What to do about a slave on the cable that the configuration does not name.
enum class ExtraSlaves : std::uint8_t { refuse, ignore };

/// What becomes of slaves with clocks that a broken ring cuts off from the reference clock.
enum class BehindBreak : std::uint8_t {
    hand_time_on,  ///< the master hands the reference's time on to them, and they run on
    ramp_down,     ///< they count as unsynchronised: their axes stop
};

/// A second interface behind the last slave: no single cable takes a slave away.
struct RingConfig {
    std::string interface2;  ///< NIC; empty: simulated, as the first one is
    BehindBreak behind_break = BehindBreak::hand_time_on;
};

struct BusConfig {
    std::string interface;  ///< NIC; empty: simulated
    BusTransport transport = BusTransport::packet;
    std::optional<RingConfig> ring;
    Duration cycle = std::chrono::milliseconds{1};
    Duration sync0_shift{};           ///< default shift; 0 = half a cycle
    std::vector<SlaveConfig> slaves;  ///< in any order
    std::vector<SyncUnitConfig> sync_units;
    ExtraSlaves extra_slaves = ExtraSlaves::refuse;
    StateTimeouts state_timeouts;
    std::uint16_t lost_frames_limit = 3;  ///< consecutive unanswered cycles until the bus alarm
    bool lock_required = true;            ///< OP only with the cycle locked to the reference clock; false: no real time, no alarm either
    std::uint8_t acyclic_per_cycle = 4;   ///< datagrams per cycle for SDO, recovery, diagnosis
};

/// How long the first copy of a frame that is back waits for the other one of a ring: well below what lies between the sending of a cycle and
/// its answers being fetched.
[[nodiscard]] inline Duration ring_patience(const BusConfig& config) noexcept { return config.cycle / 4; }

/// How often the process data of a slave is exchanged: the bus cycle times the divisor of its sync unit.
[[nodiscard]] inline Duration exchange_period(const BusConfig& config, const SlaveConfig& slave) noexcept {
    for (const auto& unit : config.sync_units)
        if (!slave.sync_unit.empty() && unit.name == slave.sync_unit && unit.divisor > 0) return unit.divisor * config.cycle;
    return config.cycle;
}

/// The SM watchdog that the master writes: configured, or three exchanges of its sync unit and at least 10 ms, so that a single
/// lost frame never trips it.
[[nodiscard]] inline Duration sm_watchdog(const BusConfig& config, const SlaveConfig& slave) noexcept {
    if (slave.sm_watchdog > Duration{}) return slave.sm_watchdog;
    return std::max<Duration>(3 * exchange_period(config, slave), std::chrono::milliseconds{10});
}
/// What the frames of the fullest cycle need on the wire until the last slave has its outputs: an estimate, from the sizes that are
/// known without the bus.
[[nodiscard]] Duration estimated_flight(const BusConfig& config);
/// What of a slave's SYNC0 shift is left for computing and jitter, when the frames' flight is taken off.
[[nodiscard]] Duration time_to_compute(const BusConfig& config, const SlaveConfig& slave);

/// The process data of the fullest cycle: how long it keeps the line busy, and until it is back through all slaves. From the sizes
/// that are known without the bus; all 0 where a slave cannot be planned.
struct BusLoad {
    Duration wire{};        ///< at 100 Mbit/s, with preamble, FCS and gaps
    Duration round_trip{};  ///< with the usual delay of each slave
    std::size_t bytes = 0, frames = 0;
};
[[nodiscard]] BusLoad bus_load(const BusConfig& config);

/// In the order of their first slaves.
[[nodiscard]] inline std::vector<HotConnectGroup> hot_connect_groups(const BusConfig& config) {
    std::vector<HotConnectGroup> groups;
    for (std::size_t i = 0; i < config.slaves.size(); ++i) {
        const auto& name = config.slaves[i].hot_connect;
        if (name.empty()) continue;
        const auto known = std::find_if(groups.begin(), groups.end(), [&](const HotConnectGroup& group) { return group.name == name; });
        if (known != groups.end()) known->slaves.push_back(i);
        else groups.push_back({name, {i}});
    }
    return groups;
}

/// Every problem of a configuration, found without a bus.
[[nodiscard]] std::vector<Error> check(const BusConfig& config);

}  // namespace taktwerk::ecat
