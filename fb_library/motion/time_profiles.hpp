#pragma once
// MC_PositionProfile, MC_VelocityProfile, MC_AccelerationProfile: PLCopen Part 1 v2.0, 3.14 to 3.16. Real-time safe.
//
// The table is a declared one (Declaration::time_table); what the axis follows is the table as it was when the command became active.
// A profile runs once. ProfileCompleted behaves like InVelocity: the axis goes on with the velocity it has, and the block stays Busy and
// Active until another command takes over.

#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

struct MC_PositionProfile : CommandBlock<MC_PositionProfile> {
    AxisRef Axis{};
    MC_TP_REF TimePosition{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    double TimeScale = 1, PositionScale = 1, Offset = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::position_profile;
    static constexpr std::string_view summary = "Moves the axis along a table of positions over time.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            shared<&Self::Axis>(), in_out<&Self::TimePosition>("", "table of times and positions"),
            shared<&Self::Execute, &Self::ContinuousUpdate>(), in<&Self::TimeScale>("1", "factor on all times, > 0; default 1"),
            in<&Self::PositionScale>("1", "factor on all positions; default 1"), in<&Self::Offset>("u", "added to every position"),
            shared<&Self::BufferMode>(), out<&Self::Done>("", "the last row is reached"), outcome<Self>());
    }

    [[nodiscard]] axes::TimeProfileDetails details() const noexcept { return {TimePosition, TimeScale, PositionScale, Offset}; }
};

struct MC_VelocityProfile : CommandBlock<MC_VelocityProfile> {
    AxisRef Axis{};
    MC_TV_REF TimeVelocity{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    double TimeScale = 1, VelocityScale = 1, Offset = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool ProfileCompleted = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::velocity_profile;
    static constexpr bool MC_VelocityProfile::*in_target_pin = &MC_VelocityProfile::ProfileCompleted;
    static constexpr std::string_view summary = "Runs the axis along a table of velocities over time and keeps the last one.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            shared<&Self::Axis>(), in_out<&Self::TimeVelocity>("", "table of times and velocities"),
            shared<&Self::Execute, &Self::ContinuousUpdate>(), in<&Self::TimeScale>("1", "factor on all times, > 0; default 1"),
            in<&Self::VelocityScale>("1", "factor on all velocities; default 1"), in<&Self::Offset>("u/s", "added to every velocity"),
            shared<&Self::BufferMode>(), out<&Self::ProfileCompleted>("", "the last row is reached"), outcome<Self>());
    }

    [[nodiscard]] axes::TimeProfileDetails details() const noexcept { return {TimeVelocity, TimeScale, VelocityScale, Offset}; }
};

struct MC_AccelerationProfile : CommandBlock<MC_AccelerationProfile> {
    AxisRef Axis{};
    MC_TA_REF TimeAcceleration{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    double TimeScale = 1, AccelerationScale = 1, Offset = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool ProfileCompleted = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::acceleration_profile;
    static constexpr bool MC_AccelerationProfile::*in_target_pin = &MC_AccelerationProfile::ProfileCompleted;
    static constexpr std::string_view summary =
        "Runs the axis along a table of accelerations over time and keeps the velocity it has then.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis>(), in_out<&Self::TimeAcceleration>("", "table of times and accelerations"),
                         shared<&Self::Execute, &Self::ContinuousUpdate>(),
                         in<&Self::TimeScale>("1", "factor on all times, > 0; default 1"),
                         in<&Self::AccelerationScale>("1", "factor on all accelerations; default 1"),
                         in<&Self::Offset>("u/s2", "added to every acceleration"), shared<&Self::BufferMode>(),
                         out<&Self::ProfileCompleted>("", "the last row is reached"), outcome<Self>());
    }

    [[nodiscard]] axes::TimeProfileDetails details() const noexcept { return {TimeAcceleration, TimeScale, AccelerationScale, Offset}; }
};

}  // namespace taktwerk::fb
