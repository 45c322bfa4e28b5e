#pragma once
// Moves that end by themselves: MC_MoveAbsolute, MC_MoveRelative, MC_MoveAdditive, PLCopen Part 1 v2.0, 3.5 to 3.7; MC_MoveModulo, with
// the pins of TwinCAT's block of that name. Real-time safe.
//
// The axis checks the inputs and answers in the call of the edge: velocity 0 or beyond range, a negative acceleration, ... give Error
// at once. Acceleration, Deceleration, Jerk 0 mean the axis' default.

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

    static constexpr auto kind = axes::CommandKind::move_absolute;
    static constexpr std::string_view summary = "Moves the axis to an absolute position.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute, &Self::ContinuousUpdate>(),  //
                         in<&Self::Position>("u", "target"), in<&Self::Velocity>("u/s", "largest velocity, > 0; need not be reached"),
                         shared<&Self::Acceleration, &Self::Deceleration, &Self::Jerk>(),
                         in<&Self::Direction>("", "for modulo axes; a linear axis ignores it"), shared<&Self::BufferMode>(),
                         out<&Self::Done>("", "target reached by the set-point, standing"), outcome<Self>());
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

    static constexpr auto kind = axes::CommandKind::move_relative;
    static constexpr std::string_view summary = "Moves the axis by a distance from the set position at the start of the motion.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute, &Self::ContinuousUpdate>(),
                         in<&Self::Distance>("u", "signed; from the set position, not the actual one"),
                         in<&Self::Velocity>("u/s", "largest velocity, > 0; need not be reached"),
                         shared<&Self::Acceleration, &Self::Deceleration, &Self::Jerk, &Self::BufferMode>(),
                         out<&Self::Done>("", "distance covered by the set-point, standing"), outcome<Self>());
    }
};

/// The distance counts from the last commanded target, also of a command that was aborted; in ContinuousMotion from the set position.
struct MC_MoveAdditive : CommandBlock<MC_MoveAdditive> {
    AxisRef Axis{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    double Distance = 0, Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::move_additive;
    static constexpr std::string_view summary = "Moves the axis by a distance from its last commanded target.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute, &Self::ContinuousUpdate>(),
                         in<&Self::Distance>("u", "signed; added to the last commanded position"),
                         in<&Self::Velocity>("u/s", "largest velocity, > 0; need not be reached"),
                         shared<&Self::Acceleration, &Self::Deceleration, &Self::Jerk, &Self::BufferMode>(),
                         out<&Self::Done>("", "target reached by the set-point, standing"), outcome<Self>());
    }
};

/// Not of PLCopen. What Position is beyond the modulo are whole turns in the direction, on top of the way to the place: from 90 deg forwards
/// to 450 is one turn, to 0 are 270 deg, to 360 are 630. The shortest way makes no turns. Only for modulo axes.
struct MC_MoveModulo : CommandBlock<MC_MoveModulo> {
    AxisRef Axis{};
    bool Execute = false;
    double Position = 0, Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_Direction Direction = mcPositiveDirection;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::move_absolute;
    static constexpr std::string_view summary = "Moves a modulo axis to a position and any number of whole turns further.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(),
                         in<&Self::Position>("u", "place in the modulo, plus the modulo times the number of turns; >= 0"),
                         in<&Self::Velocity>("u/s", "largest velocity, > 0; need not be reached"),
                         shared<&Self::Acceleration, &Self::Deceleration, &Self::Jerk>(),
                         in<&Self::Direction>("", "of the way and the turns; mcShortestWay makes no turns"), shared<&Self::BufferMode>(),
                         out<&Self::Done>("", "target reached by the set-point, standing"), outcome<Self>());
    }

    [[nodiscard]] axes::WholeTurns details() const noexcept { return {}; }
};

}  // namespace taktwerk::fb
