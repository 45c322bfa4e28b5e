#pragma once
// Types of motion pins: the axis floor's words under the names a program uses, and their descriptions for the pin tables.

#include <array>
#include <cstdint>
#include <string_view>

#include "axes/axis/motion_context.hpp"
#include "fb_library/pins/pin.hpp"

namespace taktwerk::fb {

using axes::AxisRef;
using axes::ErrorId;
using axes::MotionContext;

using axes::MC_BufferMode;
using enum axes::MC_BufferMode;
using axes::MC_Direction;
using enum axes::MC_Direction;

using axes::MC_ExecutionMode;
using enum axes::MC_ExecutionMode;
using axes::MC_Source;
using enum axes::MC_Source;
using axes::MC_StartMode;
using enum axes::MC_StartMode;
using axes::MC_SyncMode;
using enum axes::MC_SyncMode;
using axes::MC_CombineMode;
using enum axes::MC_CombineMode;

using axes::CamId;
using axes::CamRef;
using axes::CamSwitchRef;
using axes::InputRef;
using axes::OutputRef;
using axes::TimeTableRef;
using axes::TrackRef;
using axes::TriggerRef;

// One table over time, three meanings: the pin's type says which (positions, velocities, accelerations). A declared table is assigned
// as it is: `profile.TimePosition = d.time_table(...)`. NOLINTBEGIN(google-explicit-constructor)
struct MC_TP_REF : TimeTableRef {
    constexpr MC_TP_REF(TimeTableRef table = {}) noexcept : TimeTableRef{table} {}
};
struct MC_TV_REF : TimeTableRef {
    constexpr MC_TV_REF(TimeTableRef table = {}) noexcept : TimeTableRef{table} {}
};
struct MC_TA_REF : TimeTableRef {
    constexpr MC_TA_REF(TimeTableRef table = {}) noexcept : TimeTableRef{table} {}
};
// NOLINTEND(google-explicit-constructor)

/// The modes of TwinCAT's MC_Jog, in its order.
enum MC_JogMode : std::uint8_t {
    mcJogStandardSlow,   ///< the axis' configured slow manual velocity; the block's dynamics are ignored
    mcJogStandardFast,   ///< the same with the fast one
    mcJogContinuous,     ///< the block's dynamics, as long as the input is TRUE
    mcJogInching,        ///< Position as a distance, once per press
    mcJogInchingModulo,  ///< to the next multiple of Position, once per press
};

/// The loop that the drive closes (MC_SetControllerMode).
enum MC_ControllerMode : std::uint8_t { mcPositionControl, mcVelocityControl, mcTorqueControl };

namespace detail {
inline constexpr std::array<std::string_view, 6> buffer_mode_names{"mcAborting",         "mcBuffered",     "mcBlendingLow",
                                                                   "mcBlendingPrevious", "mcBlendingNext", "mcBlendingHigh"};
inline constexpr std::array<std::string_view, 4> direction_names{"mcPositiveDirection", "mcShortestWay", "mcNegativeDirection",
                                                                 "mcCurrentDirection"};
inline constexpr std::array<std::string_view, 3> execution_mode_names{"mcImmediately", "mcQueued", "mcDelayed"};
inline constexpr std::array<std::string_view, 3> source_names{"mcCommandedValue", "mcSetValue", "mcActualValue"};
inline constexpr std::array<std::string_view, 3> start_mode_names{"mcAbsolute", "mcRelative", "mcRampIn"};
inline constexpr std::array<std::string_view, 3> sync_mode_names{"mcShortest", "mcCatchUp", "mcSlowDown"};
inline constexpr std::array<std::string_view, 2> combine_mode_names{"mcAddAxes", "mcSubAxes"};
inline constexpr std::array<std::string_view, 5> jog_mode_names{"mcJogStandardSlow", "mcJogStandardFast", "mcJogContinuous", "mcJogInching",
                                                                "mcJogInchingModulo"};
inline constexpr std::array<std::string_view, 3> controller_mode_names{"mcPositionControl", "mcVelocityControl", "mcTorqueControl"};
}  // namespace detail

// clang-format off
template <> struct PinTypeOf<AxisRef> { static constexpr PinType value{PinKind::AXIS_REF, "AXIS_REF"}; };
template <> struct PinTypeOf<CamRef> { static constexpr PinType value{PinKind::HANDLE, "MC_CAM_REF"}; };
template <> struct PinTypeOf<CamId> { static constexpr PinType value{PinKind::HANDLE, "MC_CAM_ID"}; };
template <> struct PinTypeOf<MC_TP_REF> { static constexpr PinType value{PinKind::HANDLE, "MC_TP_REF"}; };
template <> struct PinTypeOf<MC_TV_REF> { static constexpr PinType value{PinKind::HANDLE, "MC_TV_REF"}; };
template <> struct PinTypeOf<MC_TA_REF> { static constexpr PinType value{PinKind::HANDLE, "MC_TA_REF"}; };
template <> struct PinTypeOf<CamSwitchRef> { static constexpr PinType value{PinKind::HANDLE, "MC_CAMSWITCH_REF"}; };
template <> struct PinTypeOf<TrackRef> { static constexpr PinType value{PinKind::HANDLE, "MC_TRACK_REF"}; };
template <> struct PinTypeOf<TriggerRef> { static constexpr PinType value{PinKind::HANDLE, "MC_TRIGGER_REF"}; };
template <> struct PinTypeOf<InputRef> { static constexpr PinType value{PinKind::HANDLE, "MC_INPUT_REF"}; };
template <> struct PinTypeOf<OutputRef> { static constexpr PinType value{PinKind::HANDLE, "MC_OUTPUT_REF"}; };
template <> struct PinTypeOf<ErrorId> { static constexpr PinType value{PinKind::WORD, "WORD"}; };
template <> struct PinTypeOf<MC_BufferMode> { static constexpr PinType value{PinKind::ENUM, "MC_BUFFER_MODE", detail::buffer_mode_names}; };
template <> struct PinTypeOf<MC_Direction> { static constexpr PinType value{PinKind::ENUM, "MC_DIRECTION", detail::direction_names}; };
template <> struct PinTypeOf<MC_ExecutionMode> {
    static constexpr PinType value{PinKind::ENUM, "MC_EXECUTION_MODE", detail::execution_mode_names};
};
template <> struct PinTypeOf<MC_Source> { static constexpr PinType value{PinKind::ENUM, "MC_SOURCE", detail::source_names}; };
template <> struct PinTypeOf<MC_StartMode> { static constexpr PinType value{PinKind::ENUM, "MC_START_MODE", detail::start_mode_names}; };
template <> struct PinTypeOf<MC_SyncMode> { static constexpr PinType value{PinKind::ENUM, "MC_SYNC_MODE", detail::sync_mode_names}; };
template <> struct PinTypeOf<MC_CombineMode> { static constexpr PinType value{PinKind::ENUM, "MC_COMBINE_MODE", detail::combine_mode_names}; };
template <> struct PinTypeOf<MC_ControllerMode> {
    static constexpr PinType value{PinKind::ENUM, "MC_CONTROLLER_MODE", detail::controller_mode_names};
};
template <> struct PinTypeOf<MC_JogMode> { static constexpr PinType value{PinKind::ENUM, "MC_JOG_MODE", detail::jog_mode_names}; };
// clang-format on

}  // namespace taktwerk::fb
