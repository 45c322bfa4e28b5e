#pragma once
// The axis' states and what leads from one to the next: PLCopen Part 1 v2.0, figure 2, as one table. Every state has an answer
// to every event; `no` means the diagram has no arrow there, and whoever asked is refused with ErrorId::state_forbids.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "axes/words/types.hpp"

namespace taktwerk::axes {

/// What moves the state machine. Notes are those of figure 2.
enum class AxisEvent : std::uint8_t {
    axis_error,       ///< note 1: an error of the axis, its drive or its bus; never of a block instance
    power_off,        ///< note 2: MC_Power.Enable is FALSE and there is no axis error; the axis stands
    reset_unpowered,  ///< note 3: MC_Reset and Power.Status FALSE
    reset_powered,    ///< note 4: MC_Reset, Power.Status TRUE and Power.Enable TRUE
    powered,          ///< note 5: Power.Enable and Power.Status TRUE, feedback works
    stop_finished,    ///< note 6: MC_Stop.Done and not MC_Stop.Execute
    stop,             ///< MC_Stop, and every stop the axis makes on its own that is not an error
    home,             ///< MC_Home
    done,             ///< the running command reached its end and nothing follows
    discrete,         ///< MoveAbsolute, MoveRelative, Halt, Jog (it ends by itself), ...
    continuous,       ///< MoveVelocity, ...
    synchronized,     ///< slave of GearIn, CamIn, ...
    superimposed,     ///< MoveSuperimposed: a motion of its own only from Standstill
    decoupled,        ///< GearOut, CamOut
    homing_step,      ///< a step of PLCopen Part 5: Homing lasts from the first one to MC_FinishHoming
};
inline constexpr std::size_t axis_event_count = 15;

namespace state_table {

using enum AxisState;
inline constexpr AxisState no = static_cast<AxisState>(0xFF);
// As wide as a column of the table. NOLINTBEGIN(readability-identifier-naming)
inline constexpr AxisState Still = Standstill, Discr = DiscreteMotion, Cont = ContinuousMotion, Sync = SynchronizedMotion;
inline constexpr AxisState Error = ErrorStop, Off = Disabled, Stop = Stopping, Home = Homing;
// NOLINTEND(readability-identifier-naming)

// clang-format off
inline constexpr std::array<std::array<AxisState, axis_event_count>, axis_state_count> rows{{
    // error  off   rst_u rst_p  power  st_fin stop  home  done   discr  cont  sync  super  decpl step
    {Error,   Off,  no,   no,    Still, no,    no,   no,   no,    no,    no,   no,   no,    no,   no},    // Disabled
    {Error,   Off,  no,   no,    no,    no,    Stop, Home, no,    Discr, Cont, Sync, Discr, no,   Home},  // Standstill
    {Error,   Off,  no,   no,    no,    no,    Stop, no,   Still, no,    no,   no,   no,    no,   Home},  // Homing
    {Error,   Off,  no,   no,    no,    no,    Stop, no,   Still, Discr, Cont, Sync, Discr, no,   no},    // DiscreteMotion
    {Error,   Off,  no,   no,    no,    no,    Stop, no,   no,    Discr, Cont, Sync, Cont,  no,   no},    // ContinuousMotion
    {Error,   Off,  no,   no,    no,    no,    Stop, no,   no,    Discr, Cont, Sync, Sync,  Cont, no},    // SynchronizedMotion
    {Error,   Off,  no,   no,    no,    Still, no,   no,   no,    no,    no,   no,   no,    no,   no},    // Stopping
    {Error,   no,   Off,  Still, no,    no,    no,   no,   no,    no,    no,   no,   no,    no,   no},    // ErrorStop
}};
// clang-format on

/// Every entry is a state or `no`; an error is possible everywhere and has the highest priority.
consteval bool sound() {
    for (const auto& row : rows) {
        for (const auto to : row)
            if (to != no && static_cast<std::size_t>(to) >= axis_state_count) return false;
        if (row[static_cast<std::size_t>(AxisEvent::axis_error)] != ErrorStop) return false;
    }
    return true;
}
static_assert(sound());
static_assert(static_cast<std::size_t>(AxisEvent::homing_step) + 1 == axis_event_count);
static_assert(static_cast<std::size_t>(ErrorStop) + 1 == axis_state_count);

}  // namespace state_table

/// Where `event` leads from `state`; nothing where the diagram has no arrow. Real-time safe.
[[nodiscard]] constexpr std::optional<AxisState> next_state(AxisState state, AxisEvent event) noexcept {
    const auto to = state_table::rows[static_cast<std::size_t>(state)][static_cast<std::size_t>(event)];
    if (to == state_table::no) return std::nullopt;
    return to;
}

}  // namespace taktwerk::axes
