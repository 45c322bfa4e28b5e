#pragma once
// MC_ExtSetPointGenEnable, MC_ExtSetPointGenFeed, MC_ExtSetPointGenDisable: a program gives the set-points itself, cycle by cycle. Names
// after TwinCAT's Tc2_MC2; not part of PLCopen. Real-time safe.
//
//   enable.Execute = true;                 feed.Enable = enable.Busy;
//   enable(ctx);                           feed.Position = ..., feed.Velocity = ..., feed.Acceleration = ...;
//                                          feed(ctx);  // in each scan; the set-point takes effect in this cycle
//
// In a slower task the axis is fed at the task's rate. What the axis does with a gap or a jump stands in axes/axis/README.md.

#include <string_view>

#include "fb_library/motion/enable_core.hpp"
#include "fb_library/motion/execute_block.hpp"
#include "fb_library/motion/setting_follower.hpp"

namespace taktwerk::fb {

/// The axis is in ContinuousMotion until another command takes over.
struct MC_ExtSetPointGenEnable : CommandBlock<MC_ExtSetPointGenEnable> {
    AxisRef Axis{};
    bool Execute = false;

    bool Enabled = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::external;
    static constexpr bool MC_ExtSetPointGenEnable::*in_target_pin = &MC_ExtSetPointGenEnable::Enabled;
    static constexpr std::string_view summary = "Lets the program give the axis' set-points.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), out<&Self::Enabled>("", "the axis is at the set-point that was fed"),
                         outcome<Self>());
    }
};

/// No direction as in TwinCAT: the sign of Velocity says it.
struct MC_ExtSetPointGenFeed {
    using Self = MC_ExtSetPointGenFeed;
    AxisRef Axis{};
    bool Enable = false;
    double Position = 0, Velocity = 0, Acceleration = 0;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    EnableCore core{};
    SettingFollower answer{};

    static constexpr std::string_view summary = "Gives the axis its next set-point.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis>(), in<&Self::Enable>("", "feeds in each call while TRUE"),
                         in<&Self::Position>("u", "set position"), in<&Self::Velocity>("u/s", "set velocity, signed"),
                         in<&Self::Acceleration>("u/s2", "set acceleration, signed"),
                         out<&Self::Valid>("", "the axis takes the set-points"), outcome<Self>());
    }

    void operator()(const MotionContext& ctx) noexcept {
        if (core.begin(Enable) != EnableCore::Edge::none) answer = {};
        if (core.working())
            core.took(ctx.view(Axis) != nullptr ? answer.ask(ctx, Axis, axes::SetpointFeed{Position, Velocity, Acceleration})
                                                : Reading::unless(ErrorId::invalid_axis));
        core.publish(*this);
    }
    void warm_start(Instant) noexcept { answer = {}; }
};

/// A halt. An axis that is not fed from outside is left alone: state_forbids.
struct MC_ExtSetPointGenDisable : CommandBlock<MC_ExtSetPointGenDisable> {
    AxisRef Axis{};
    bool Execute = false;
    double Deceleration = 0, Jerk = 0;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::halt;
    static constexpr std::string_view summary = "Ends the feeding of set-points and brings the axis to standstill.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute, &Self::Deceleration, &Self::Jerk>(),
                         out<&Self::Done>("", "set velocity is zero"), outcome<Self>());
    }

private:
    friend ExecuteBlock<MC_ExtSetPointGenDisable>;
    void start(const MotionContext& ctx) noexcept {
        const axes::AxisView* view = ctx.view(Axis);
        if (view != nullptr && view->active_kind != axes::CommandKind::external) return core_.refuse(ErrorId::state_forbids);
        CommandBlock<MC_ExtSetPointGenDisable>::start(ctx);
    }
};

}  // namespace taktwerk::fb
