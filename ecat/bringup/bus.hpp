#pragma once
// What the scripts of one bus share: the slaves as configured and found, the port to the wire, and the few numbers that
// cross to the cycle and back (atomics; everything else here belongs to the service side alone).

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/bringup/process_data_plan.hpp"
#include "ecat/bringup/refusal.hpp"
#include "ecat/bus_config.hpp"
#include "ecat/coe/sdo_client.hpp"
#include "ecat/dc/cycle_servo.hpp"
#include "ecat/script/datagram_port.hpp"
#include "ecat/topology/topology.hpp"
#include "ecat/wire/al_status.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat {

/// The same values as Master::Phase.
enum class BusPhase : std::uint8_t { idle, scanning, preop, configuring, safeop, operational, failed, stopping, stopped };

/// Which slaves have an answer in their mailbox, as the cycle saw it last (SlavePlan::mailbox_bit numbers the bits). A bit
/// that is set is certain. One that is not says little of a slave whose FMMU is not programmed or that is away: ask such a
/// slave itself, now and then, while `exact` does not count on.
struct MailboxBits {
    std::array<std::atomic<std::uint64_t>, MailboxStatusPlan::max_size / 8> words{};
    std::atomic<std::uint32_t> exact{0};  ///< answers to which every slave with a bit contributed; wraps

    /// For a slave's mailbox, once its FMMU is programmed.
    [[nodiscard]] MailboxFlag flag(std::uint32_t bit) const noexcept { return {&words[bit / 64], bit % 64}; }
    /// By the cycle, with the data of the datagram. Real-time safe.
    void publish(std::span<const std::byte> data, bool all_contributed) noexcept {
        for (std::size_t w = 0; w * 8 < data.size() && w < words.size(); ++w) {
            std::uint64_t word = 0;
            for (std::size_t i = w * 8; i < std::min(data.size(), w * 8 + 8); ++i) word |= std::uint64_t(data[i]) << (8 * (i % 8));
            words[w].store(word, std::memory_order_relaxed);
        }
        if (all_contributed) exact.store(exact.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    }
};

/// Numbers between the cycle and the scripts.
struct CycleLink {
    // Written by the cycle.
    std::atomic<std::uint64_t> cycles{0};            ///< process data sent
    std::atomic<std::uint32_t> good_in_a_row{0};     ///< cycles in which every datagram had its working counter
    std::atomic<std::int64_t> send_phase_ns{0};      ///< of send(), modulo the bus cycle, smoothed
    std::atomic<std::int64_t> first_send_ns{0};      ///< when send() was cycle 0 of the plan, had no cycle been missed since
    std::atomic<std::int64_t> dc_offset_ns{0};       ///< reference clock minus machine time, at sending; smoothed
    std::atomic<bool> dc_measured{false};            ///< dc_offset_ns is
    std::atomic<std::int64_t> dc_phase_error_ns{0};  ///< of the servo
    std::atomic<DcLock> dc_lock{DcLock::none};
    std::atomic<std::uint32_t> dc_missing{0};           ///< cycles since the reference's time came
    std::atomic<std::uint32_t> states_seen{0};          ///< OR of all AL states (low 5 bits), of the last BRD
    std::atomic<std::uint16_t> worst_datagram{0xFFFF};  ///< a datagram whose working counter was wrong last; FFFFh: none was
    std::atomic<std::uint16_t> worst_wkc{0};
    MailboxBits mailbox;
    std::atomic<std::uint16_t> slaves_answering{0};  ///< working counter of the last BRD that came back
    std::atomic<std::uint32_t> lost_in_a_row{0};     ///< cycles without an answer
    std::atomic<std::uint64_t> foreign_frames{0};    ///< EtherCAT frames of another sender
    std::atomic<std::uint64_t> foreign_source{0};    ///< address of the last of them, first byte on top
    std::atomic<std::int64_t> stall_ns{0};           ///< so long this computer sent nothing when it last came too late
    std::atomic<std::int64_t> stall_ended_ns{0};     ///< and when it sent again; 0: it never was
    std::atomic<std::uint32_t> gap_cycles{0};        ///< so many cycles in a row were not answered when two or more last were
    std::atomic<std::int64_t> gap_ended_ns{0};       ///< and when the last of them was missed; 0: never
    // Written by the scripts.
    std::atomic<bool> supervise{false};             ///< slaves are in SAFEOP or above: wrong working counters count
    std::atomic<std::int64_t> dc_difference_ns{0};  ///< worst 092Ch
    std::atomic<std::int64_t> dc_phase_ns{-1};      ///< system time of send(), modulo the cycle, that the servo keeps; -1: not fixed
    std::atomic<std::uint32_t> clock_holds{0};      ///< above 0: a reference is being set: read its time, give it to nobody
    std::atomic<std::uint64_t> reference{0};        ///< who serves as reference clock: station + (ns behind the first << 16)
    std::atomic<bool> foreign_master{false};        ///< foreign frames came in lately, more than a defect explains
};

/// What a slave or drive says so soon after this computer sent nothing for a while follows from that: its watchdogs and counters of
/// missed frames run for some cycles more, and the watch takes a moment to read the reason.
inline constexpr Duration stall_remembered = std::chrono::milliseconds{500};
/// How long this computer sent nothing right before `now`; nothing when it was in time.
[[nodiscard]] inline Duration recent_stall(const CycleLink& link, Instant now) noexcept {
    const std::int64_t ended = link.stall_ended_ns.load(std::memory_order_relaxed);
    const bool recent = ended != 0 && now.time_since_epoch().count() - ended <= stall_remembered.count();
    return recent ? Duration{link.stall_ns.load(std::memory_order_relaxed)} : Duration{};
}

/// How many cycles in a row were not answered right before `now`, at most; 0: no two of them.
[[nodiscard]] inline std::uint32_t recent_gap(const CycleLink& link, Instant now) noexcept {
    const std::int64_t ended = link.gap_ended_ns.load(std::memory_order_relaxed);
    const bool recent = ended != 0 && now.time_since_epoch().count() - ended <= stall_remembered.count();
    return recent ? link.gap_cycles.load(std::memory_order_relaxed) : 0;
}

/// What the watch heard from a slave at its station address when it asked last.
enum class Presence : std::uint8_t {
    answers,
    unheard,  ///< no frame came back: nothing is known
    silent,   ///< frames come back, nobody answered
};

/// Why a slave that is on the cable does not come back to OP.
enum class ReturnTrouble : std::uint8_t { none, refused, other_device };

/// What a slave's controller and EEPROM said during the scan.
struct FoundSlave {
    std::uint16_t position = 0, station = 0;
    Identity identity;
    std::uint16_t alias = 0;  ///< register 0012h; the EEPROM's, which counts after the next power-on, is sii.alias
    std::uint16_t features = 0, dl_status = 0;
    std::uint8_t fmmus = 0, sync_managers = 0;
    std::array<std::uint16_t, 4> mailbox{};  ///< SII: out start, out size, in start, in size
    Sii sii;                                 ///< everything its EEPROM says
    std::optional<std::uint16_t> device_id;  ///< read only where a configuration addresses by it
    std::optional<Error> error;              ///< could not be read
};

struct BusSlave {
    const SlaveConfig* config = nullptr;
    std::size_t index = 0;  ///< in the configuration
    std::string subject;    ///< "slave 3 'y_drive' (sv33-e)"
    FoundSlave found;
    MailboxEndpoint mailbox;
    std::vector<PdoDescription> rx, tx;  ///< as the slave maps them now
    std::string last_abort;              ///< for the diagnosis of a refused state
    std::optional<Refusal> refusal;      ///< why it did not take the state asked last; none: it did
    bool in_line = false;                ///< the bring-up gave it a place and a plan: recovery is possible

    bool dc = false;                 ///< has a clock
    std::uint32_t dc_delay = 0;      ///< 0928h
    std::uint64_t dc_offset = 0;     ///< 0920h
    std::int64_t dc_difference = 0;  ///< ns, magnitude of 092Ch when it was read last

    // Of a running bus, for watch and recovery.
    std::optional<std::uint16_t> position_now;  ///< by the last census; none: not on the cable
    bool identified = true;                     ///< its EEPROM was read since it was last missed
    std::string last_trouble;                   ///< why the last attempt to get it back failed

    // What the cycle touches for each slave: one cache line.
    alignas(64) std::atomic<std::uint32_t> age{0};  ///< written by the cycle: cycles since its process data was exchanged

    // Read by the cycle.
    std::atomic<Presence> presence{Presence::answers};
    std::atomic<ReturnTrouble> trouble{ReturnTrouble::none};
    std::atomic<std::uint32_t> attempts{0};  ///< to get it back, in a row
    std::atomic<bool> mailbox_silent{false};
    std::atomic<bool> taken_down{false};       ///< to set it up again; until it is back in OP
    std::atomic<std::uint32_t> al{0};          ///< AL status in the low word, status code in the high word
    std::atomic<std::int64_t> sync0_start{0};  ///< an instant of SYNC0 in system time; 0: does not run
    std::atomic<std::uint32_t> recoveries{0};

    [[nodiscard]] const DeviceDescription& device() const noexcept { return *config->device; }
    [[nodiscard]] bool has_mailbox() const noexcept { return config->device->mailbox.has_value(); }
    [[nodiscard]] bool has_coe() const noexcept { return config->device->mailbox && config->device->mailbox->coe; }
};

struct Bus {
    Bus(const BusConfig& configuration, AcyclicChannel& channel) : config(configuration), port(channel) {}

    const BusConfig& config;
    DatagramPort port;
    CycleLink link;
    std::vector<std::unique_ptr<BusSlave>> slaves;  ///< configuration order
    std::vector<FoundSlave> found;                  ///< all on the cable, by position; also those that nobody configured
    Topology topology;                              ///< of `found`
    ProcessDataPlan plan;
    std::optional<std::size_t> reference;  ///< the slave whose clock is the bus' clock
    std::optional<std::int64_t> dc_phase;  ///< system time of a cycle start, modulo the cycle; fixed at the first SYNC0
    std::atomic<bool> runs_sync0{false};   ///< some slave does, so the cycle has to be locked to the reference
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

/// A step of one slave.
using SlaveStep = Script<Result<void>> (*)(Bus&, BusSlave&);
/// Runs a step for all slaves side by side; the first error in configuration order.
[[nodiscard]] Script<Result<void>> for_each_slave(Bus& bus, SlaveStep step);

}  // namespace taktwerk::ecat
