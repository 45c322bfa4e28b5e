#pragma once
// The few numbers that cross between the cycle and the scripts of the service side, of the bus and of each slave. Atomics only.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/time.hpp"
#include "ecat/alarm_set.hpp"
#include "ecat/dc/cycle_servo.hpp"
#include "ecat/layout/process_data_plan.hpp"
#include "ecat/ring/ring_state.hpp"

namespace taktwerk::ecat {

/// Above it a clock is off: drives that supervise theirs give up there (SV33-E P0A.32: 3000 ns).
inline constexpr std::int64_t clock_is_off_ns = 3000;

/// Which slaves have an answer in their mailbox, as the cycle saw it last (SlavePlan::mailbox_bit numbers the bits). A bit
/// that is set is certain. One that is not says little of a slave whose FMMU is not programmed or that is away: ask such a
/// slave itself, now and then, while `exact` does not count on.
struct MailboxBits {
    std::array<std::atomic<std::uint64_t>, MailboxStatusPlan::max_size / 8> words{};
    std::atomic<std::uint32_t> exact{0};  ///< answers to which every slave with a bit contributed; wraps

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

/// Conditions that only the scripts can see: they say so here, FaultFinder decides what of it is raised.
class SeenAlarms {
public:
    /// Returns whether it held before.
    template <BusAlarm alarm>
    bool say(bool holds) noexcept {
        constexpr std::uint64_t bit = BusAlarmSet::bit<alarm>;
        return ((holds ? bits_.fetch_or(bit) : bits_.fetch_and(~bit)) & bit) != 0;
    }
    [[nodiscard]] BusAlarmSet load() const noexcept { return BusAlarmSet{bits_.load(std::memory_order_relaxed)}; }

private:
    std::atomic<std::uint64_t> bits_{0};
};

/// The ring as it was seen last. One word, so that shape and numbers are of one frame.
class SeenRing {
public:
    void store(const RingState& ring) noexcept {
        word_.store(static_cast<std::uint64_t>(ring.shape) | std::uint64_t{ring.before_break} << 16 |
                        std::uint64_t{ring.behind_break} << 32 | std::uint64_t{ring.whole} << 48,
                    std::memory_order_relaxed);
    }
    /// Without the count of openings.
    [[nodiscard]] RingState load() const noexcept {
        const std::uint64_t word = word_.load(std::memory_order_relaxed);
        return {static_cast<RingShape>(word & 0xFF), static_cast<std::uint16_t>(word >> 16), static_cast<std::uint16_t>(word >> 32), 0,
                static_cast<std::uint16_t>(word >> 48)};
    }

private:
    std::atomic<std::uint64_t> word_{0};
};

/// The reference clock against machine time.
struct ReferenceTime {
    std::atomic<std::int64_t> offset_ns{0};  ///< reference minus machine time, at sending; smoothed
    std::atomic<std::int64_t> drift_ppb{0};  ///< how much faster the reference runs
    std::atomic<bool> measured{false};       ///< offset_ns is
};

/// What happened to the line as a whole: each count says that something did, also when it is over again.
struct LineEvents {
    std::atomic<bool> link_up{true};          ///< of the network port, now
    std::atomic<std::uint32_t> upheavals{0};  ///< how often slaves came, went or began anew, or a ring opened or closed (Upheavals)
    std::atomic<std::uint16_t> guests{0};     ///< slaves on the cable that are not always there, whoever they are; by the scripts
    std::atomic<std::uint32_t> silences{0};   ///< how often so many frames in a row were lost that it was an alarm
};

/// Numbers between the cycle and the scripts.
struct CycleLink {
    // Written by the cycle.
    std::atomic<std::uint64_t> cycles{0};         ///< process data sent
    std::atomic<std::uint32_t> good_in_a_row{0};  ///< cycles in which every datagram had its working counter
    std::atomic<std::int64_t> send_phase_ns{0};   ///< of send(), modulo the bus cycle, smoothed
    std::atomic<std::int64_t> first_send_ns{0};   ///< when send() was cycle 0 of the plan, had no cycle been missed since
    ReferenceTime dc_time;
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
    LineEvents line;
    SeenRing ring;
    // Written by the scripts.
    std::atomic<bool> supervise{false};             ///< slaves are in SAFEOP or above: wrong working counters count
    std::atomic<std::int64_t> dc_difference_ns{0};  ///< worst 092Ch
    std::atomic<std::int64_t> dc_phase_ns{-1};      ///< system time of send(), modulo the cycle, that the servo keeps; -1: not fixed
    std::atomic<std::uint32_t> clock_holds{0};      ///< above 0: a reference is being set: read its time, give it to nobody
    std::atomic<std::uint64_t> reference{0};        ///< who serves as reference clock: station + (ns behind the first << 16)
    SeenAlarms seen;
    std::atomic<bool> runs_sync0{false};  ///< some slave does, so the cycle has to be locked to the reference
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

/// Of a slave that comes and goes with its group; of all others `there`.
enum class Attendance : std::uint8_t {
    there,    ///< in OP once: what is wrong with it now is a fault
    away,     ///< nothing is expected of it
    joining,  ///< plugged in, on its way to OP
};

/// Why a slave that is on the cable does not come back to OP.
enum class ReturnTrouble : std::uint8_t { none, refused, other_device };

/// What a slave counted at one of its ports within the last minute; nothing of it: all zero.
struct CableErrors {
    std::uint8_t port = 0, lost_links = 0;
    std::uint16_t errors = 0;
};

/// The same, from the scripts to the cycle. One word, so that port and numbers are of one look.
class SeenCable {
public:
    void store(const CableErrors& cable) noexcept {
        word_.store(std::uint32_t{cable.port} | std::uint32_t{cable.lost_links} << 8 | std::uint32_t{cable.errors} << 16,
                    std::memory_order_relaxed);
    }
    [[nodiscard]] CableErrors load() const noexcept {
        const std::uint32_t word = word_.load(std::memory_order_relaxed);
        return {static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8), static_cast<std::uint16_t>(word >> 16)};
    }

private:
    std::atomic<std::uint32_t> word_{0};
};

/// Numbers between the cycle and the scripts of one slave, in a cache line of their own.
struct alignas(64) SlaveLink {
    std::atomic<std::uint32_t> age{0};  ///< written by the cycle: cycles since its process data was exchanged
    // Written by the scripts.
    std::atomic<Presence> presence{Presence::answers};
    std::atomic<Attendance> attendance{Attendance::there};
    std::atomic<ReturnTrouble> trouble{ReturnTrouble::none};
    std::atomic<std::uint32_t> attempts{0};  ///< to get it back, in a row
    SeenAlarms seen;
    SeenCable cable;                           ///< of the port that counted most
    std::atomic<bool> taken_down{false};       ///< to set it up again; until it is back in OP
    std::atomic<std::uint32_t> al{0};          ///< AL status in the low word, status code in the high word
    std::atomic<std::int64_t> sync0_start{0};  ///< an instant of SYNC0 in system time; 0: does not run
    std::atomic<std::uint32_t> recoveries{0};
};

}  // namespace taktwerk::ecat
