#pragma once
// MC_MoveAbsolute, MC_MoveRelative, MC_MoveVelocity: PLCopen Part 1 v2.0, 3.5, 3.6, 3.10. Real-time safe.
//
// The axis checks the inputs and answers in the call of the edge: velocity 0 or beyond range, a negative acceleration, ... give Error
// at once. Acceleration, Deceleration, Jerk 0 mean the axis' default.

#include <array>
#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

struct MC_MoveAbsolute : CommandBlock<MC_MoveAbsolute> {
    AxisRef Axis{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    double Position = 0, Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_Direction Direction = mcPositiveDirection;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Moves the axis to an absolute position.";
    static consteval auto pins() {
        return std::array{
            in_out<&Self::Axis>("", "axis acted on"),
            in<&Self::Execute>("", "a rising edge starts"),
            in<&Self::ContinuousUpdate>("", "not supported so far: TRUE at the edge gives Error"),
            in<&Self::Position>("u", "target"),
            in<&Self::Velocity>("u/s", "largest velocity, > 0; need not be reached"),
            in<&Self::Acceleration>("u/s2", "0 = the axis' default"),
            in<&Self::Deceleration>("u/s2", "0 = the axis' default"),
            in<&Self::Jerk>("u/s3", "0 = the axis' default"),
            in<&Self::Direction>("", "for modulo axes; a linear axis ignores it"),
            in<&Self::BufferMode>("", "when the command takes effect"),
            out<&Self::Done>("", "target reached by the set-point, standing"),
            out<&Self::Busy>("", "not finished"),
            out<&Self::Active>("", "this command controls the axis"),
            out<&Self::CommandAborted>("", "another command took over, or power went off"),
            out<&Self::Error>("", "refused, or ended by an axis error"),
            out<&Self::ErrorID>("", "why"),
        };
    }

    [[nodiscard]] axes::AxisCommand command() const noexcept {
        return {.kind = axes::CommandKind::move_absolute,
                .buffer_mode = BufferMode,
                .direction = Direction,
                .position = Position,
                .velocity = Velocity,
                .acceleration = Acceleration,
                .deceleration = Deceleration,
                .jerk = Jerk};
    }
};

struct MC_MoveRelative : CommandBlock<MC_MoveRelative> {
    AxisRef Axis{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    double Distance = 0, Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Moves the axis by a distance from the set position at the start of the motion.";
    static consteval auto pins() {
        return std::array{
            in_out<&Self::Axis>("", "axis acted on"),
            in<&Self::Execute>("", "a rising edge starts"),
            in<&Self::ContinuousUpdate>("", "not supported so far: TRUE at the edge gives Error"),
            in<&Self::Distance>("u", "signed; from the set position, not the actual one"),
            in<&Self::Velocity>("u/s", "largest velocity, > 0; need not be reached"),
            in<&Self::Acceleration>("u/s2", "0 = the axis' default"),
            in<&Self::Deceleration>("u/s2", "0 = the axis' default"),
            in<&Self::Jerk>("u/s3", "0 = the axis' default"),
            in<&Self::BufferMode>("", "when the command takes effect"),
            out<&Self::Done>("", "distance covered by the set-point, standing"),
            out<&Self::Busy>("", "not finished"),
            out<&Self::Active>("", "this command controls the axis"),
            out<&Self::CommandAborted>("", "another command took over, or power went off"),
            out<&Self::Error>("", "refused, or ended by an axis error"),
            out<&Self::ErrorID>("", "why"),
        };
    }

    [[nodiscard]] axes::AxisCommand command() const noexcept {
        return {.kind = axes::CommandKind::move_relative,
                .buffer_mode = BufferMode,
                .position = Distance,
                .velocity = Velocity,
                .acceleration = Acceleration,
                .deceleration = Deceleration,
                .jerk = Jerk};
    }
};

/// InVelocity follows the set-point, never the actual value; it is FALSE for at least the call of a new edge, also with the same velocity.
struct MC_MoveVelocity : CommandBlock<MC_MoveVelocity> {
    AxisRef Axis{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_Direction Direction = mcPositiveDirection;
    MC_BufferMode BufferMode = mcAborting;

    bool InVelocity = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr bool MC_MoveVelocity::*in_target_pin = &MC_MoveVelocity::InVelocity;
    static constexpr std::string_view summary = "Runs the axis at a velocity until something else takes it.";
    static consteval auto pins() {
        return std::array{
            in_out<&Self::Axis>("", "axis acted on"),
            in<&Self::Execute>("", "a rising edge starts"),
            in<&Self::ContinuousUpdate>("", "not supported so far: TRUE at the edge gives Error"),
            in<&Self::Velocity>("u/s", "signed; the sense times Direction; 0 is allowed"),
            in<&Self::Acceleration>("u/s2", "0 = the axis' default"),
            in<&Self::Deceleration>("u/s2", "0 = the axis' default"),
            in<&Self::Jerk>("u/s3", "0 = the axis' default"),
            in<&Self::Direction>("", "positive, negative or current; shortest way is an error"),
            in<&Self::BufferMode>("", "when the command takes effect"),
            out<&Self::InVelocity>("", "the set velocity is the commanded one"),
            out<&Self::Busy>("", "not finished"),
            out<&Self::Active>("", "this command controls the axis"),
            out<&Self::CommandAborted>("", "another command took over, or power went off"),
            out<&Self::Error>("", "refused, or ended by an axis error"),
            out<&Self::ErrorID>("", "why"),
        };
    }

    [[nodiscard]] axes::AxisCommand command() const noexcept {
        return {.kind = axes::CommandKind::move_velocity,
                .buffer_mode = BufferMode,
                .direction = Direction,
                .velocity = Velocity,
                .acceleration = Acceleration,
                .deceleration = Deceleration,
                .jerk = Jerk};
    }
};

}  // namespace taktwerk::fb
