#pragma once
// What must hold of every block in every call, whatever it is given: the lifecycle's outputs exclude each other, an error has its reason, what is over
// stays so until its input falls. And pins drawn at random.

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "fb_library/all_blocks.hpp"
#include "tests/axes/group/by_hand.hpp"
#include "tests/axes/group/jog_arms.hpp"

namespace taktwerk::fb {

class PinDraws {
public:
    explicit PinDraws(std::uint64_t seed) : random_(seed) {}
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
    bool chance(double p) { return uniform(0, 1) < p; }

    /// Where a place is drawn near to: the members, and the tool's point in the machine.
    axes::JointVector members{};
    std::array<double, 6> tool{}, tool_seen{};  ///< seen: from the world
    AxisRef belt{}, table{};
    std::size_t member_count = 0;

    /// Any of this many enumerators, seldom one more: which is none.
    template <class Enum>
    Enum any(int count) {
        return static_cast<Enum>(chance(0.02) ? count : whole(0, count - 1));
    }
    /// Seldom what is no number of a machine.
    double number(double from, double to) {
        constexpr std::array bad{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300, 1e13};
        return chance(0.003) ? bad[static_cast<std::size_t>(whole(0, 3))] : uniform(from, to);
    }
    double speed() { return chance(0.2) ? number(-1, 0) : std::exp(number(std::log(10.), std::log(300.))); }
    double ramp() { return chance(0.6) ? number(-1, 0) : std::exp(number(std::log(200.), std::log(5000.))); }

private:
    std::mt19937_64 random_;
};

/// New inputs for a block, whichever it has.
template <class Block>
void draw(Block& b, PinDraws& d) {
    constexpr bool relative = requires { b.Distance; };
    const bool by = [&] {
        if constexpr (requires { b.Relative; }) return b.Relative = d.chance(0.5);
        return relative || std::is_same_v<Block, MC_MoveCircularRelative>;
    }();
    if constexpr (requires { b.CoordSystem; }) {
        constexpr std::array often{mcACS, mcMCS, mcMCS, mcWCS, mcPCS, mcPCS_3, mcTCS};
        b.CoordSystem = d.chance(0.05) ? d.any<MC_CoordSystem>(13) : often[static_cast<std::size_t>(d.whole(0, 6))];
    }
    const auto place = [&](auto& at) {
        const double size = std::exp(d.uniform(std::log(0.01), std::log(40.)));
        for (std::size_t i = 0; i < d.member_count; ++i) at.A.Axes[i] = (by ? 0 : d.members[i]) + d.number(-size, size);
        std::array<double, 6> six{};
        for (std::size_t i = 0; i < 6; ++i)
            six[i] = (by ? 0 : d.tool[i]) + (i < 3 ? d.number(-size, size) : d.chance(0.3) ? d.number(-0.3, 0.3) : 0);
        at.C.Tcp = {six[0], six[1], six[2], six[3], six[4], six[5]};
        at.C.Cfg = {d.chance(0.1), d.chance(0.5), d.chance(0.5), d.chance(0.5)};
    };
    if constexpr (requires { b.Position.C; }) place(b.Position);
    if constexpr (requires { b.Distance.C; }) place(b.Distance);
    if constexpr (requires { b.AuxPoint.C; }) place(b.AuxPoint), place(b.EndPoint);
    if constexpr (requires { b.InputPosition.C; }) place(b.InputPosition);
    if constexpr (requires { b.Velocity = 1.0; }) b.Velocity = d.speed();
    if constexpr (requires { b.Acceleration = 1.0; }) b.Acceleration = d.ramp();
    if constexpr (requires { b.Deceleration; }) b.Deceleration = d.ramp();
    if constexpr (requires { b.Jerk = 1.0; }) b.Jerk = d.chance(0.7) ? 0 : std::exp(d.uniform(std::log(2000.), std::log(1e5)));
    if constexpr (requires { b.BufferMode; }) b.BufferMode = d.any<MC_BufferMode>(6);
    if constexpr (requires { b.TransitionMode; }) {
        b.TransitionMode = d.any<MC_TransitionMode>(5);
        b.TransitionParameter.Parameter[0] = d.number(0, d.chance(0.5) ? 1 : 20);
    }
    if constexpr (requires { b.TransitionVelocity; }) b.TransitionVelocity = d.any<MC_TransitionVelocity>(5);
    if constexpr (requires { b.CircMode; }) {
        b.CircMode = d.any<MC_CIRC_MODE>(3);
        b.PathChoice = d.any<MC_CIRC_PATHCHOICE>(2);
    }
    if constexpr (requires { b.ExecutionMode; }) b.ExecutionMode = d.any<MC_ExecutionMode>(3);
    if constexpr (requires { b.TransX = 1.0; }) {
        b.TransX = d.number(-50, 50), b.TransY = d.number(-50, 50), b.TransZ = d.number(-50, 50);
        b.RotAngle3 = d.number(-3, 3);
    }
    if constexpr (requires { b.CoordTransform.X = 1.0; })
        b.CoordTransform = {d.number(-50, 50), d.number(-50, 50), 0, 0, 0, d.number(-3, 3)};
    const auto moving = [&](MC_COORD_REF& origin, MC_COORD_REF& object) {
        using axes::test::hand_frame;
        const std::array<double, 6> seen{
            d.tool_seen[0] + d.number(-40, 40), d.tool_seen[1] + d.number(-40, 40), d.tool_seen[2], 0, 0, d.number(-3, 3)};
        std::array<double, 6> place = d.tool_seen;
        for (std::size_t i = 0; i < 3; ++i) place[i] += d.number(-5, 5);
        const auto at = axes::test::hand_six(axes::test::back(hand_frame(seen)) * hand_frame(place));
        origin = {seen[0], seen[1], seen[2], seen[3], seen[4], seen[5]};
        object = {at[0], at[1], at[2], at[3], at[4], at[5]};
    };
    if constexpr (requires { b.ConveyorBelt; }) {
        b.ConveyorBelt = d.chance(0.02) ? AxisRef{static_cast<std::uint16_t>(d.whole(0, 20))} : d.belt;
        moving(b.ConveyorBeltOrigin, b.InitialObjectPosition);
    }
    if constexpr (requires { b.RotaryTable; }) {
        b.RotaryTable = d.chance(0.02) ? d.belt : d.table;
        moving(b.RotaryTableOrigin, b.InitialObjectPosition);
    }
    if constexpr (
        requires { b.ConveyorBelt; } || requires { b.RotaryTable; })
        b.BufferMode = d.chance(0.1) ? d.any<MC_BufferMode>(6) : d.chance(0.6) ? mcAborting : mcBuffered;
    if constexpr (requires { b.ToolNumber; }) b.ToolNumber = static_cast<std::int16_t>(d.whole(-1, 3));
    if constexpr (requires { b.ToolData; })
        b.ToolData.ToolFrame = {d.number(-20, 20), d.number(-20, 20), d.number(-20, 20), 0, 0, d.number(-1, 1)};
    if constexpr (requires { b.PayloadNumber; }) b.PayloadNumber = static_cast<std::int16_t>(d.whole(-1, 3));
    if constexpr (requires { b.PayloadData; }) b.PayloadData.Mass = d.number(-0.1, 2);
    if constexpr (requires { b.RigidBodyCount; }) b.RigidBodyCount = static_cast<std::int16_t>(d.whole(-1, 9));
    if constexpr (requires { b.Duration; }) b.Duration = std::chrono::milliseconds(d.whole(-5, 200));
    if constexpr (requires { b.ParameterNumber; }) {
        b.ParameterNumber = static_cast<MC_GroupParameter>(d.whole(0, 3));
        b.Value = d.number(0, 1.2);
    }
    if constexpr (requires { b.LimitValues; })
        for (auto& axis : b.LimitValues.Axes) axis = {d.number(100, 150), d.number(-150, -100)};
    if constexpr (requires { b.AxisVelocity; })
        for (double& v : b.AxisVelocity) v = d.number(-5, 40);
    if constexpr (requires { b.IdentInGroup; }) b.IdentInGroup = static_cast<std::uint8_t>(d.whole(0, 8));
}

/// What is wrong with the outputs of a block with Execute; empty: nothing. Once a call, behind it.
class ExecuteLife {
public:
    template <class Block>
    [[nodiscard]] std::string look(const Block& b) {
        bool aborted = false;
        if constexpr (requires { b.CommandAborted; }) aborted = b.CommandAborted;
        const int shown = static_cast<int>(b.Busy) + static_cast<int>(b.Done) + static_cast<int>(aborted) + static_cast<int>(b.Error);
        std::string wrong;
        if (b.Execute ? shown != 1 : shown > 1)
            wrong +=
                "Busy " + text(b.Busy) + " Done " + text(b.Done) + " CommandAborted " + text(aborted) + " Error " + text(b.Error) + "; ";
        if (b.Error != (b.ErrorID != axes::ErrorId::none)) wrong += "Error without its reason; ";
        if constexpr (requires { b.Active; })
            if (b.Active && !b.Busy) wrong += "Active without Busy; ";
        if constexpr (requires { b.CommandAccepted; })
            if (b.CommandAccepted && !b.Busy) wrong += "CommandAccepted without Busy; ";
        const std::array over{b.Done, aborted, b.Error};
        const bool stays = b.Execute && executed_ && over_ != std::array{false, false, false};
        if (stays && over != over_) wrong += "it was over, and is so otherwise; ";
        over_ = over;
        executed_ = b.Execute;
        return wrong;
    }

private:
    static std::string text(bool value) { return value ? "TRUE" : "FALSE"; }
    std::array<bool, 3> over_{};
    bool executed_ = false;
};

/// Likewise, with Enable.
template <class Block>
[[nodiscard]] std::string look_at_reading(const Block& b) {
    std::string wrong;
    bool valid = false;
    if constexpr (requires { b.Valid; }) valid = b.Valid;
    if constexpr (requires { b.Enabled; }) valid = b.Enabled;
    if (valid && b.Error) wrong += "valid, and an error; ";
    if (b.Error != (b.ErrorID != axes::ErrorId::none)) wrong += "Error without its reason; ";
    if (!b.Enable && (valid || b.Error)) wrong += "not enabled, and says something; ";
    return wrong;
}

}  // namespace taktwerk::fb
