#pragma once
// What the campaign does to a bus, and when.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace taktwerk::campaign {

enum class FaultKind : std::uint8_t {
    frames_lost,           ///< one or two frames
    frames_lost_long,      ///< all frames for 5 to 40 ms
    answers_late,          ///< one or two answers, 1.2 to 5 ms
    answers_late_long,     ///< each answer, for 8 to 30 ms
    answers_twice,         ///< up to 50 answers
    answers_reordered,     ///< two answers behind their successors
    answer_bits_flipped,   ///< one bit in each of up to five answers, checksums right
    request_bits_flipped,  ///< the same on the way out: slaves get wrong registers
    counter_too_small,     ///< working counters of process data, for 5 to 20 cycles
    counter_too_large,
    state_refused,       ///< a slave refuses SAFEOP or OP from below, for two seconds
    power_cycled,        ///< a slave is without power for 5 to 300 ms
    power_cycled_twice,  ///< and again in the middle of its return
    power_gone,          ///< for good
    other_device,        ///< power-cycled, and another product stands there
    cable_pulled,        ///< for 20 to 500 ms, anywhere
    cable_gone,          ///< for good
    link_down,           ///< at the master's port, for 20 to 500 ms
    foreign_frames,      ///< another master's frames are heard for a second
    address_changed,     ///< a slave's station address is cleared by somebody else
    state_changed,       ///< a slave is sent to INIT, PREOP or SAFEOP by somebody else
    settings_changed,    ///< an FMMU is cleared by somebody else
    mailbox_stuck,       ///< for 0.5 to 3 s
    mailbox_dead,        ///< for good
    reference_frozen,    ///< the reference time stands for 0.3 to 1 s
    stall_20ms,          ///< the master does nothing
    stall_200ms,
    stall_2s,
};
inline constexpr std::array<std::string_view, 28> fault_names{
    "frames_lost",         "frames_lost_long",     "answers_late",      "answers_late_long", "answers_twice", "answers_reordered",
    "answer_bits_flipped", "request_bits_flipped", "counter_too_small", "counter_too_large", "state_refused", "power_cycled",
    "power_cycled_twice",  "power_gone",           "other_device",      "cable_pulled",      "cable_gone",    "link_down",
    "foreign_frames",      "address_changed",      "state_changed",     "settings_changed",  "mailbox_stuck", "mailbox_dead",
    "reference_frozen",    "stall_20ms",           "stall_200ms",       "stall_2s"};

/// When it strikes: a moment in the phase, drawn from the seed.
enum class Phase : std::uint8_t { scanning, preop, configuring, safeop, standstill, moving, stopping };
inline constexpr std::array<std::string_view, 7> phase_names{"scanning",   "preop",  "configuring", "safeop",
                                                             "standstill", "moving", "stopping"};

[[nodiscard]] constexpr std::string_view name(FaultKind kind) noexcept { return fault_names[static_cast<std::size_t>(kind)]; }
[[nodiscard]] constexpr std::string_view name(Phase phase) noexcept { return phase_names[static_cast<std::size_t>(phase)]; }

/// The cause is still there when the run ends.
[[nodiscard]] constexpr bool for_good(FaultKind kind) noexcept {
    return kind == FaultKind::power_gone || kind == FaultKind::other_device || kind == FaultKind::cable_gone ||
           kind == FaultKind::mailbox_dead;
}

}  // namespace taktwerk::campaign
