#pragma once
// The parameters of an axis by number: PLCopen's 1 to 17 (Part 1 v2.0, 3.19 table 5) and Taktwerk's own from 1000 on. One table: what
// each is called, its unit, whether it may be written, and where its value stands in the view. What is written holds until the
// runtime starts again: the machine file is the memory. Real-time safe.

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

#include "axes/axis/axis_view.hpp"

namespace taktwerk::axes {

/// The numbers that code names; all others stand in the table only.
enum Parameter : std::int32_t {
    commanded_position = 1,
    software_limit_positive = 2,
    software_limit_negative = 3,
    enable_limit_positive = 4,
    enable_limit_negative = 5,
    enable_lag_monitoring = 6,
    maximum_lag = 7,
    velocity_of_system = 8,
    velocity_of_application = 9,
    acceleration_of_system = 12,
    acceleration_of_application = 13,
    deceleration_of_system = 14,
    deceleration_of_application = 15,
    jerk_of_system = 16,
    jerk_of_application = 17,
    in_position_window = 1010,
    in_position_time = 1011,
    standstill_velocity = 1012,
    lag_time = 1013,
    default_acceleration = 1014,
    default_deceleration = 1015,
    default_jerk = 1016,
    lag_per_velocity = 1017,
    jog_velocity_slow = 1020,
    jog_velocity_fast = 1021,
    setup_velocity = 1022,
    velocity_positive = 1023,
    velocity_negative = 1024,
    acceleration_positive = 1025,
    acceleration_negative = 1026,
    deceleration_positive = 1027,
    deceleration_negative = 1028,
};

enum class ParameterType : std::uint8_t { real, boolean };
/// Which values may be written. `at_most` of the entry bounds all of them from above.
enum class ParameterRange : std::uint8_t { read_only, finite, not_negative, positive, boolean };

struct ParameterInfo {
    std::int32_t number = 0;
    std::string_view name;  ///< 1..17 as the standard spells them
    std::string_view unit;  ///< "" = none
    ParameterType type = ParameterType::real;
    ParameterRange range = ParameterRange::read_only;
    double (*read)(const AxisView&) noexcept = nullptr;
    std::string_view doc;
    std::int32_t at_most = 0;  ///< number of the parameter whose value is the upper bound; 0 = none
};

/// Where in AxisView::parameters a stored one stands: 2..17 under their number, then the vendor's in their order.
[[nodiscard]] constexpr std::size_t place_of(Parameter parameter) noexcept {
    if (parameter < in_position_window) return static_cast<std::size_t>(parameter);
    if (parameter <= default_jerk) return static_cast<std::size_t>(18 + parameter - in_position_window);
    if (parameter == lag_per_velocity) return 28;
    if (parameter >= velocity_positive) return static_cast<std::size_t>(29 + parameter - velocity_positive);
    return static_cast<std::size_t>(25 + parameter - jog_velocity_slow);
}
static_assert(place_of(deceleration_negative) < std::tuple_size_v<decltype(AxisView::parameters)>);

namespace detail {
template <Parameter P>
[[nodiscard]] double stored(const AxisView& view) noexcept {
    return view.parameters[place_of(P)];
}
template <auto Member>
[[nodiscard]] double live(const AxisView& view) noexcept {
    return static_cast<double>(view.*Member);
}
}  // namespace detail

// clang-format off
inline constexpr std::array parameter_table{
    ParameterInfo{1, "CommandedPosition", "u", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::set_position>,
     "set position of this cycle"},
    ParameterInfo{2, "SWLimitPos", "u", ParameterType::real, ParameterRange::finite, detail::stored<software_limit_positive>,
     "software limit in positive direction; holds once the axis is homed. A value that the moving axis cannot stop before is refused"},
    ParameterInfo{3, "SWLimitNeg", "u", ParameterType::real, ParameterRange::finite, detail::stored<software_limit_negative>,
     "the same in negative direction"},
    ParameterInfo{4, "EnableLimitPos", "", ParameterType::boolean, ParameterRange::boolean, detail::stored<enable_limit_positive>,
     "SWLimitPos is watched"},
    ParameterInfo{5, "EnableLimitNeg", "", ParameterType::boolean, ParameterRange::boolean, detail::stored<enable_limit_negative>,
     "SWLimitNeg is watched"},
    ParameterInfo{6, "EnablePosLagMonitoring", "", ParameterType::boolean, ParameterRange::boolean, detail::stored<enable_lag_monitoring>,
     "the following error is watched"},
    ParameterInfo{7, "MaxPositionLag", "u", ParameterType::real, ParameterRange::not_negative, detail::stored<maximum_lag>,
     "following error beyond which the axis stops in error, after 1013 LagTime"},
    ParameterInfo{8, "MaxVelocitySystem", "u/s", ParameterType::real, ParameterRange::read_only, detail::stored<velocity_of_system>,
     "as configured; nothing moves faster"},
    ParameterInfo{9, "MaxVelocityAppl", "u/s", ParameterType::real, ParameterRange::positive, detail::stored<velocity_of_application>,
     "greatest velocity of commands, from their next planning on", velocity_of_system},
    ParameterInfo{10, "ActualVelocity", "u/s", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::actual_velocity>,
     "signed"},
    ParameterInfo{11, "CommandedVelocity", "u/s", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::set_velocity>,
     "set velocity of this cycle, signed"},
    ParameterInfo{12, "MaxAccelerationSystem", "u/s2", ParameterType::real, ParameterRange::read_only, detail::stored<acceleration_of_system>,
     "as configured"},
    ParameterInfo{13, "MaxAccelerationAppl", "u/s2", ParameterType::real, ParameterRange::positive, detail::stored<acceleration_of_application>,
     "greatest acceleration of commands, from their next planning on", acceleration_of_system},
    ParameterInfo{14, "MaxDecelerationSystem", "u/s2", ParameterType::real, ParameterRange::read_only, detail::stored<deceleration_of_system>,
     "as configured"},
    ParameterInfo{15, "MaxDecelerationAppl", "u/s2", ParameterType::real, ParameterRange::positive, detail::stored<deceleration_of_application>,
     "greatest deceleration of commands; stops for errors and emergencies keep what is configured. Written at standstill only",
     deceleration_of_system},
    ParameterInfo{16, "MaxJerkSystem", "u/s3", ParameterType::real, ParameterRange::read_only, detail::stored<jerk_of_system>,
     "as configured; infinite = not limited"},
    ParameterInfo{17, "MaxJerkAppl", "u/s3", ParameterType::real, ParameterRange::positive, detail::stored<jerk_of_application>,
     "greatest jerk of commands; stops for errors and emergencies keep what is configured. Written at standstill only", jerk_of_system},

    ParameterInfo{1000, "ActualPosition", "u", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::actual_position>, ""},
    ParameterInfo{1001, "CommandedAcceleration", "u/s2", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::set_acceleration>,
     "of the set position, signed"},
    ParameterInfo{1002, "CommandedJerk", "u/s3", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::set_jerk>,
     "of the set position, signed"},
    ParameterInfo{1003, "TargetPosition", "u", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::target_position>,
     "where the present motion ends"},
    ParameterInfo{1004, "FollowingError", "u", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::following_error>,
     "set position in effect when the actual one was taken, minus that"},
    ParameterInfo{1005, "ActualTorque", "", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::actual_torque>,
     "fraction of rated torque, signed"},
    ParameterInfo{1006, "VelFactor", "", ParameterType::real, ParameterRange::read_only,
     [](const AxisView& view) noexcept { return view.override_factors.velocity; }, "override; written by MC_SetOverride"},
    ParameterInfo{1007, "AccFactor", "", ParameterType::real, ParameterRange::read_only,
     [](const AxisView& view) noexcept { return view.override_factors.acceleration; }, "override; written by MC_SetOverride"},
    ParameterInfo{1008, "JerkFactor", "", ParameterType::real, ParameterRange::read_only,
     [](const AxisView& view) noexcept { return view.override_factors.jerk; }, "override; written by MC_SetOverride"},
    ParameterInfo{1009, "FollowingWindow", "u", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::following_window>,
     "what the following error may be now: 7 MaxPositionLag, and 1017 LagPerVelocity times the set velocity"},
    ParameterInfo{1010, "InPositionWindow", "u", ParameterType::real, ParameterRange::not_negative, detail::stored<in_position_window>,
     "actual position this near to the target counts as in position"},
    ParameterInfo{1011, "InPositionTime", "s", ParameterType::real, ParameterRange::not_negative, detail::stored<in_position_time>,
     "... once it has been there for so long"},
    ParameterInfo{1012, "StandstillVelocity", "u/s", ParameterType::real, ParameterRange::not_negative, detail::stored<standstill_velocity>,
     "actual velocity that counts as none; also the window of MC_ReadMotionState"},
    ParameterInfo{1013, "LagTime", "s", ParameterType::real, ParameterRange::not_negative, detail::stored<lag_time>,
     "the following error may be beyond 7 MaxPositionLag for so long"},
    ParameterInfo{1014, "DefaultAcceleration", "u/s2", ParameterType::real, ParameterRange::not_negative, detail::stored<default_acceleration>,
     "of commands that say 0; 0 = 13 MaxAccelerationAppl", acceleration_of_system},
    ParameterInfo{1015, "DefaultDeceleration", "u/s2", ParameterType::real, ParameterRange::not_negative, detail::stored<default_deceleration>,
     "of commands that say 0; 0 = 15 MaxDecelerationAppl", deceleration_of_system},
    ParameterInfo{1016, "DefaultJerk", "u/s3", ParameterType::real, ParameterRange::not_negative, detail::stored<default_jerk>,
     "of commands that say 0; 0 = 17 MaxJerkAppl", jerk_of_system},
    ParameterInfo{1017, "LagPerVelocity", "s", ParameterType::real, ParameterRange::not_negative, detail::stored<lag_per_velocity>,
     "by so much for each u/s of set velocity the following error may be more than 7 MaxPositionLag"},
    ParameterInfo{1020, "JogVelocitySlow", "u/s", ParameterType::real, ParameterRange::positive, detail::stored<jog_velocity_slow>,
     "of jogging", velocity_of_system},
    ParameterInfo{1021, "JogVelocityFast", "u/s", ParameterType::real, ParameterRange::positive, detail::stored<jog_velocity_fast>,
     "of jogging, and the greatest velocity in manual mode", velocity_of_system},
    ParameterInfo{1022, "SetupVelocity", "u/s", ParameterType::real, ParameterRange::positive, detail::stored<setup_velocity>,
     "greatest velocity in set-up mode", velocity_of_system},
    ParameterInfo{1023, "MaxVelocityPos", "u/s", ParameterType::real, ParameterRange::read_only, detail::stored<velocity_positive>,
     "greatest velocity of commands in positive direction: 9 MaxVelocityAppl, or less as configured"},
    ParameterInfo{1024, "MaxVelocityNeg", "u/s", ParameterType::real, ParameterRange::read_only, detail::stored<velocity_negative>,
     "the same in negative direction"},
    ParameterInfo{1025, "MaxAccelerationPos", "u/s2", ParameterType::real, ParameterRange::read_only, detail::stored<acceleration_positive>,
     "greatest acceleration while the axis gets faster in positive direction: 13 MaxAccelerationAppl, or less as configured"},
    ParameterInfo{1026, "MaxAccelerationNeg", "u/s2", ParameterType::real, ParameterRange::read_only, detail::stored<acceleration_negative>,
     "the same in negative direction"},
    ParameterInfo{1027, "MaxDecelerationPos", "u/s2", ParameterType::real, ParameterRange::read_only, detail::stored<deceleration_positive>,
     "greatest deceleration while the axis gets slower in positive direction: 15 MaxDecelerationAppl, or less as configured"},
    ParameterInfo{1028, "MaxDecelerationNeg", "u/s2", ParameterType::real, ParameterRange::read_only, detail::stored<deceleration_negative>,
     "the same in negative direction"},
    ParameterInfo{1030, "Modulo", "u", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::modulo>, "0 = a linear axis"},
    ParameterInfo{1031, "Turns", "", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::turns>,
     "whole moduli of the set position since zero"},
    ParameterInfo{1040, "AxisError", "", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::error>,
     "alarm that holds the axis in ErrorStop; 0 = none"},
    ParameterInfo{1041, "DriveError", "", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::drive_error>,
     "the drive's own number (603Fh); 0 = none"},
    ParameterInfo{1042, "StatusWord", "", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::status_word>, "6041h, raw"},
    ParameterInfo{1043, "DigitalInputs", "", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::digital_inputs>,
     "of the drive (60FDh), raw"},
    ParameterInfo{1044, "DigitalOutputs", "", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::digital_outputs>,
     "of the drive (60FEh), as written"},
    ParameterInfo{1045, "TorqueLimitPos", "", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::torque_limit_positive>,
     "fraction of rated torque that the drive may give in positive direction; infinite = what it has; set by MC_SetTorqueLimit"},
    ParameterInfo{1046, "TorqueLimitNeg", "", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::torque_limit_negative>,
     "the same in negative direction"},
    ParameterInfo{1047, "Brake", "", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::brake>,
     "that the controller works: 1 closed, 2 opening, 3 open, 4 closing; 0 = the drive works it"},
    ParameterInfo{1048, "Skew", "u", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::skew>,
     "of a gantry: how far its follower is ahead of its leader, since both have power"},
    ParameterInfo{1049, "LoadDifference", "u", ParameterType::real, ParameterRange::read_only, detail::live<&AxisView::load_difference>,
     "how far the load is ahead of the motor, by its own encoder"},
    ParameterInfo{1050, "Homed", "", ParameterType::boolean, ParameterRange::read_only, detail::live<&AxisView::homed>, ""},
    ParameterInfo{1051, "InPosition", "", ParameterType::boolean, ParameterRange::read_only, detail::live<&AxisView::in_position>, ""},
    ParameterInfo{1052, "Online", "", ParameterType::boolean, ParameterRange::read_only, detail::live<&AxisView::online>,
     "the drive's feedback is fresh"},
};
// clang-format on

/// nullptr: the axis has no such parameter.
[[nodiscard]] constexpr const ParameterInfo* find_parameter(std::int32_t number) noexcept {
    for (const auto& entry : parameter_table)
        if (entry.number == number) return &entry;
    return nullptr;
}

/// Whether the axis could take it, as far as its view tells: unknown_parameter, read_only_parameter, invalid_parameter (outside its range).
[[nodiscard]] inline ErrorId check_write(const AxisView& view, const WriteParameter& wanted) noexcept {
    const auto* entry = find_parameter(wanted.number);
    if (!entry) return ErrorId::unknown_parameter;
    const double value = wanted.value;
    bool inside = std::isfinite(value);
    switch (entry->range) {
        case ParameterRange::read_only: return ErrorId::read_only_parameter;
        case ParameterRange::finite: break;
        case ParameterRange::not_negative: inside = inside && value >= 0; break;
        case ParameterRange::positive: inside = inside && value > 0; break;
        case ParameterRange::boolean: inside = value == 0 || value == 1; break;
    }
    if (entry->at_most != 0) inside = inside && value <= view.parameters[static_cast<std::size_t>(entry->at_most)];
    if (entry->number == software_limit_positive) inside = inside && value > view.parameters[software_limit_negative];
    if (entry->number == software_limit_negative) inside = inside && value < view.parameters[software_limit_positive];
    return inside ? ErrorId::none : ErrorId::invalid_parameter;
}

namespace parameter_check {
/// Numbers rise (so none stands twice), all have a name, and 18 to 999 stay the standard's (P1-216). That each can be read is a test's
/// business: a function compared with nullptr is no constant expression under the undefined-behaviour sanitizer.
consteval bool sound() {
    std::int32_t before = 0;
    for (const auto& entry : parameter_table) {
        if (entry.number <= before || (entry.number > 17 && entry.number < 1000) || entry.name.empty()) return false;
        if ((entry.range == ParameterRange::boolean) && entry.type != ParameterType::boolean) return false;
        before = entry.number;
    }
    return true;
}
static_assert(sound());
}  // namespace parameter_check

}  // namespace taktwerk::axes
