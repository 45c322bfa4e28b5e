#pragma once
// What the scripts of one bus share: the slaves as configured and found, the port to the wire, and the numbers that cross to the
// cycle and back (ecat/cycle/cycle_link.hpp; everything else here belongs to the service side alone).

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/bringup/refusal.hpp"
#include "ecat/bus_config.hpp"
#include "ecat/coe/sdo_client.hpp"
#include "ecat/cycle/bus_phase.hpp"
#include "ecat/cycle/cycle_link.hpp"
#include "ecat/layout/process_data_plan.hpp"
#include "ecat/script/datagram_port.hpp"
#include "ecat/topology/topology.hpp"
#include "ecat/wire/al_status.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat {

/// What a slave's controller and EEPROM said during the scan.
struct FoundSlave {
    std::uint16_t position = 0, station = 0;
    Identity identity;
    std::uint16_t alias = 0;  ///< register 0012h; the EEPROM's, which counts after the next power-on, is sii.alias
    std::uint16_t features = 0, dl_status = 0;
    std::uint8_t fmmus = 0, sync_managers = 0;
    std::array<std::uint16_t, 4> mailbox{};  ///< SII: out start, out size, in start, in size
    Sii sii;                                 ///< everything its EEPROM says
    std::optional<std::uint16_t>
        device_id;               ///< read where a configuration addresses by it, and by a survey of slaves that say they have one
    std::optional<Error> error;  ///< could not be read
};

/// Where a slave of a group stands, as long as nobody knows, and in the tree of the bring-up, where it counts for nothing.
inline constexpr std::uint16_t not_on_the_cable = 0xFFFF;
/// Station addresses of slaves of groups, by their place in the configuration; below are those of the bring-up, by position.
inline constexpr std::uint16_t first_guest_station = 0x4000;

struct BusSlave {
    const SlaveConfig* config = nullptr;
    std::size_t index = 0;  ///< in the configuration
    std::string subject;    ///< "slave 3 'y_drive' (sv33-e)"
    FoundSlave found;
    std::optional<DeviceDescription> own;  ///< where nobody stated all of the configured one: with the slave's own word in it
    MailboxEndpoint mailbox;
    std::vector<PdoDescription> rx, tx;                 ///< as the slave maps them now
    std::vector<std::optional<std::uint32_t>> answers;  ///< to config->asked; none: it has no such object
    std::vector<FoundOutput> kept;                      ///< outputs of a mapping that nobody stated, beyond what was asked for
    std::string last_abort;                             ///< for the diagnosis of a refused state
    std::optional<Refusal> refusal;                     ///< why it did not take the state asked last; none: it did
    bool in_line = false;                               ///< the bring-up gave it a place and a plan: recovery is possible

    bool dc = false;                 ///< has a clock
    std::uint32_t dc_delay = 0;      ///< 0928h
    std::uint64_t dc_offset = 0;     ///< 0920h
    std::int64_t dc_difference = 0;  ///< ns, magnitude of 092Ch when it was read last

    // Of a running bus, for watch and recovery.
    std::optional<std::uint16_t> position_now;  ///< by the last census; none: not on the cable
    bool identified = true;                     ///< its EEPROM was read since it was last missed
    std::string last_trouble;                   ///< why the last attempt to get it back failed
    std::string not_exchanged;                  ///< why its process data was not, when it was asked last; empty: it never was

    SlaveLink link;

    [[nodiscard]] const DeviceDescription& device() const noexcept { return own ? *own : *config->device; }
    /// It comes and goes, and is not in operation now.
    [[nodiscard]] bool away() const noexcept { return link.attendance.load() != Attendance::there; }
    [[nodiscard]] bool has_mailbox() const noexcept { return device().mailbox.has_value(); }
    [[nodiscard]] bool has_coe() const noexcept { return device().mailbox && device().mailbox->coe; }
};

struct Bus {
    Bus(const BusConfig& configuration, AcyclicChannel& channel) : config(configuration), port(channel) {}

    const BusConfig& config;
    DatagramPort port;
    CycleLink link;
    std::vector<std::unique_ptr<BusSlave>> slaves;  ///< configuration order
    std::vector<FoundSlave> found;                  ///< all on the cable, by position; also those that nobody configured
    Topology topology;                              ///< of `found`
    std::vector<HotConnectGroup> groups = hot_connect_groups(config);
    unsigned address_holds = 0;       ///< above 0: who does not answer to its address may have it back in a moment
    bool group_left = false;          ///< since the newcomers were looked at
    bool groups_at_rest = false;      ///< all newcomers were asked, and have joined, or were left alone
    std::string strangers;            ///< who was plugged in and belongs to no group; empty: nobody
    std::optional<RingEnd> ring_end;  ///< of a ring, while it is a line (ring_line.hpp)
    std::uint16_t line_of = 0;        ///< so many slaves answered when it became one
    ProcessDataPlan plan;
    std::optional<std::size_t> reference;  ///< the slave whose clock is the bus' clock
    std::optional<std::int64_t> dc_phase;  ///< system time of a cycle start, modulo the cycle; fixed at the first SYNC0
    std::atomic<BusPhase> phase{BusPhase::idle};
    std::string progress;
    std::uint32_t census = 0;    ///< how often position_now was taken anew
    bool census_wanted = false;  ///< a slave does not answer where it should
    std::uint16_t counted = 0;   ///< slaves on the cable at the last census
    /// Hands the plan to the cycle: from now on process data is exchanged.
    std::function<void()> publish;
    EmergencyLog emergencies;
    std::vector<std::string> notes;  ///< recoveries and other remarkable things, newest last
    std::uint64_t remembered = 0;    ///< notes ever made; the oldest are forgotten

    void note(const BusSlave& slave, const std::string& doing) { progress = slave.subject + " " + doing; }
    void remember(std::string text) {
        if (notes.size() >= 100) notes.erase(notes.begin());
        notes.push_back(std::move(text));
        ++remembered;
    }
};

/// While it lives nobody is missed for want of an answer to its address.
class AddressHold {
public:
    explicit AddressHold(Bus& bus) noexcept : bus_(bus) { ++bus_.address_holds; }
    ~AddressHold() { --bus_.address_holds; }
    AddressHold(const AddressHold&) = delete;
    AddressHold& operator=(const AddressHold&) = delete;

private:
    Bus& bus_;
};

/// A step of one slave.
using SlaveStep = Script<Result<void>> (*)(Bus&, BusSlave&);
/// Runs a step for all slaves that are there side by side; the first error in configuration order.
[[nodiscard]] Script<Result<void>> for_each_slave(Bus& bus, SlaveStep step);

}  // namespace taktwerk::ecat
