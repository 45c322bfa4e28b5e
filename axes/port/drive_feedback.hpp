#pragma once
// What a drive says in a cycle. Units: axes/port/drive_port.hpp.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "axes/port/drive_states.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

struct ProbeFeedback {
    bool armed = false;  ///< the drive confirms that it waits for edges (false while a re-arming is under way)
    bool latched = false;
    std::uint16_t count = 0;    ///< latches since armed
    std::int64_t position = 0;  ///< counts at the edge
};

/// What became of torque limits that are not mapped.
enum class TorqueLimitAnswer : std::uint8_t { taken, pending, refused };

/// What the drive says. All of one latch instant.
struct DriveFeedback {
    // What is new in every cycle of a motor that turns: first, and side by side.
    Instant latched{};          ///< when the actual values were taken
    std::int64_t position = 0;  ///< counts, unwrapped
    double velocity = 0;        ///< counts/s; from the drive, else differentiated
    double torque = 0;          ///< fraction of rated

    // How it is with the drive: mostly as in the cycle before.
    std::uint32_t age = 0;               ///< bus cycles since it was fresh
    std::uint32_t digital_inputs = 0;    ///< raw
    std::uint32_t profile_accepted = 0;  ///< sequence of the last profile set-point the drive has taken
    std::uint16_t status_word = 0;       ///< raw, for people
    std::uint16_t error_code = 0;        ///< 603Fh or the vendor's number; 0 = none
    /// Counts each time the position's zero may have become another: the drive was away and came back, homed, or lost its turns.
    std::uint16_t position_epoch = 0;
    /// Counts each time the drive lost what homing gave it: its turns were cleared, or an alarm says so. The axis is unreferenced then.
    std::uint16_t reference_epoch = 0;
    bool fresh = false;   ///< new in this cycle
    bool online = false;  ///< exchanged at all (bus in OP, line answering); false: everything else is old
    PowerState power = PowerState::unknown;
    DriveMode mode = DriveMode::none;  ///< active mode (6061h), or the commanded one where the drive cannot say
    bool fault = false, warning = false;
    bool main_power = true;  ///< statusword bit 4 where it means that
    bool target_reached = false, internal_limit = false;
    bool homing_attained = false, homing_error = false;
    bool follows_target = true;         ///< statusword bit 12 in cyclic modes, where it means that
    bool homing_setup_refused = false;  ///< DriveCommand::homing could not be written: no start is sent until it is taken back
    /// The drive has acknowledged all that encode() asked that changes its state; false: still under way (polled drives).
    bool commands_acknowledged = true;
    TorqueLimitAnswer torque_limits = TorqueLimitAnswer::taken;  ///< to those of the last command, where they are written acyclically
    bool setup_refused = false;                                  ///< the drive's settings forbid enabling it; setup_problems() says which
    bool has_inputs = false;
    bool negative_limit = false, positive_limit = false, home_switch = false;
    std::array<ProbeFeedback, 2> probes{};

    /// `other` says the same of the drive: at most the actual values and their time are others. (Or it does and this is not seen, by padding.)
    [[nodiscard]] bool differs_in_motion_only(const DriveFeedback& other) const noexcept;
    void take_motion(const DriveFeedback& from) noexcept {
        latched = from.latched;
        position = from.position;
        velocity = from.velocity;
        torque = from.torque;
    }
};

inline bool DriveFeedback::differs_in_motion_only(const DriveFeedback& other) const noexcept {
    using TwoWords [[gnu::vector_size(16)]] = std::uint64_t;
    constexpr std::size_t first = offsetof(DriveFeedback, age), last = sizeof(DriveFeedback) - sizeof(TwoWords);
    static_assert(first == offsetof(DriveFeedback, torque) + sizeof(torque), "the actual values come first");
    static_assert(last - first == 56, "compared below, the last two words with an overlap");
    const auto difference = [&](std::size_t at) noexcept {
        TwoWords mine, others;
        std::memcpy(&mine, reinterpret_cast<const std::byte*>(this) + at, sizeof mine);
        std::memcpy(&others, reinterpret_cast<const std::byte*>(&other) + at, sizeof others);
        return mine ^ others;
    };
    const auto any = difference(first) | difference(first + 16) | difference(first + 32) | difference(first + 48) | difference(last);
    return (any[0] | any[1]) == 0;
}

}  // namespace taktwerk::axes
