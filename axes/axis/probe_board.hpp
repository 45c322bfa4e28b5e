#pragma once
// The probes of one axis that wait for their event: which are armed, what they watch, and when an event has come. Knows nothing of the
// axis' units and windows: it says where the event was, in counts, and the axis says whether that counts. Real-time safe.
//
// Two kinds. A *latch* of the drive (probe 1, probe 2, index pulse) gives the position at the edge itself. A *software* probe (a switch
// of the drive, an input of the machine) sees the level once per cycle: the edge was somewhere between the last two samples, most
// probably, and never more than half a cycle from, in the middle. So the recorded position is uncertain by half the way of one cycle
// to either side, plus the delay of the input itself. A pulse that is shorter than a cycle may be missed.
//
// A latch of the drive waits for events some cycles after it was armed: the drive must first have let go of its former arming
// (axes/drives/cia402/probe_latch.hpp) and have the command.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "axes/axis/command_details.hpp"
#include "axes/axis/position_track.hpp"
#include "axes/port/drive_port.hpp"

namespace taktwerk::axes {

class ProbeBoard {
public:
    static constexpr std::size_t places = 2;  ///< one for each side slot

    /// What this cycle shows.
    struct Signals {
        const DriveFeedback& feedback;
        std::span<const std::int64_t> inputs;  ///< of the machine
        const PositionTrack& track;            ///< holds the feedback's position already
        Instant inputs_taken{};                ///< when the machine's inputs were sampled
        Duration cycle{};
    };

    /// Takes a free place. Errors: no_such_probe, invalid_output (no such input), probe_busy (its trigger, or all places).
    [[nodiscard]] ErrorId arm(CommandId id, const ProbeDetails& probe, const DriveCapabilities& drive, const Signals& now) noexcept;
    /// The command that waited for this trigger, and does no more; 0 = none did.
    [[nodiscard]] CommandId release(const TriggerRef& trigger) noexcept;
    void release(CommandId id) noexcept;

    /// Some probe waits.
    [[nodiscard]] bool armed() const noexcept { return places_[0].id != 0 || places_[1].id != 0; }
    /// Once per cycle in which one is armed, after the feedback. At most one event of each place; see event().
    void observe(const Signals& now) noexcept;
    /// Where the event of this cycle was, if there was one: it is for the caller to release() the place or to let it wait on.
    [[nodiscard]] std::optional<FinePosition> event(std::size_t place) const noexcept { return places_[place].event; }

    /// 0 = free.
    [[nodiscard]] CommandId id(std::size_t place) const noexcept { return places_[place].id; }
    [[nodiscard]] const ProbeDetails& details(std::size_t place) const noexcept { return places_[place].probe; }

    /// Arms the drive's latches. Once per cycle.
    void command(std::array<ProbeCommand, 2>& latches) noexcept {
        if (in_use()) arm_latches(latches);
    }
    /// Some probe waits, or the drive has not been told yet that none does.
    [[nodiscard]] bool in_use() const noexcept { return armed() || sent_[0] || sent_[1]; }

private:
    static constexpr std::uint8_t software = 0xFF;
    struct Place {
        CommandId id = 0;
        ProbeDetails probe;
        std::uint8_t channel = software;  // of the drive
        std::uint16_t seen = 0;           // latches of this arming
        bool level = false;               // software: in the cycle before
        std::optional<FinePosition> event;
    };

    void arm_latches(std::array<ProbeCommand, 2>& latches) noexcept;
    [[nodiscard]] bool channel_used(std::uint8_t channel) const noexcept;
    [[nodiscard]] ErrorId choose_channel(const ProbeDetails& probe, const DriveCapabilities& drive, std::uint8_t& channel) const noexcept;
    static void watch_latch(Place& place, const ProbeFeedback& latch) noexcept;
    static void watch_level(Place& place, const Signals& now) noexcept;

    std::array<Place, places> places_{};
    std::array<bool, 2> sent_{};        // armed in the last command
    std::array<bool, 2> letting_go_{};  // armed anew: the former arming must be seen to end first
};

}  // namespace taktwerk::axes
