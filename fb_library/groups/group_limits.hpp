#pragma once
// How fast a group moves where a command does not say it, and how far its members may go: MC_GroupWriteDefaultDynamics, MC_GroupReadDefaultDynamics,
// MC_GroupReadSWLimits, MC_GroupWriteSWLimits. PLCopen Part 4 v2.0. Real-time safe.

#include <string_view>

#include "axes/axis/parameters.hpp"
#include "fb_library/groups/group_block.hpp"

namespace taktwerk::fb {

/// 0 or less leaves a value as it is.
struct MC_GroupWriteDefaultDynamics : GroupSettingBlock<MC_GroupWriteDefaultDynamics> {
    GroupRef AxesGroup{};
    bool Execute = false;
    double Velocity = -1, Acceleration = -1, Deceleration = -1, Jerk = -1;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Says how fast the group moves where a command does not.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            grouped<&Self::AxesGroup, &Self::Execute>(), in<&Self::Velocity>("u/s", "along the path; 0 or less = stays as it is"),
            in<&Self::Acceleration>("u/s2", "likewise"), in<&Self::Deceleration>("u/s2", "likewise"), in<&Self::Jerk>("u/s3", "likewise"),
            out<&Self::Done>("", "later commands have them"), grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupSetting setting() const noexcept {
        return axes::WriteDynamics{axes::WriteDynamics::Which::default_dynamics, {Velocity, Acceleration, Deceleration, Jerk}};
    }
};

struct MC_GroupReadDefaultDynamics : GroupReadBlock<MC_GroupReadDefaultDynamics> {
    GroupRef AxesGroup{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;

    static constexpr std::string_view summary = "Gives how fast the group moves where a command does not say it.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), reading<Self>(),
                         out<&Self::Velocity>("u/s", "along the path; 0 = what the axes' limits leave"),
                         out<&Self::Acceleration>("u/s2", "likewise"), out<&Self::Deceleration>("u/s2", "likewise"),
                         out<&Self::Jerk>("u/s3", "likewise"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        const auto& known = view.default_dynamics;
        Velocity = known.velocity;
        Acceleration = known.acceleration;
        Deceleration = known.deceleration;
        Jerk = known.jerk;
        return Reading::valid();
    }
    void clear() noexcept { Velocity = Acceleration = Deceleration = Jerk = 0; }
};

/// The axes' own limits: there are no others.
struct MC_GroupReadSWLimits : GroupReadBlock<MC_GroupReadSWLimits> {
    GroupRef AxesGroup{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    MC_GROUP_SWLIMITS LimitValues{};

    static constexpr std::string_view summary = "Gives the software limits of all members.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), reading<Self>(), out<&Self::LimitValues>("", "u; infinity = none"));
    }
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        const axes::GroupView* view = view_of(ctx, AxesGroup);
        if (view == nullptr) return Reading::unless(ErrorId::invalid_group);
        for (std::size_t i = 0; i < axes::most_members; ++i) {
            const axes::AxisView* axis = view->has(i) ? ctx.view(view->members[i]) : nullptr;
            LimitValues.Axes[i] = axis == nullptr ? MC_GROUP_SWLIMITS::Limits{}
                                                  : MC_GROUP_SWLIMITS::Limits{axis->parameters[axes::software_limit_positive],
                                                                              axis->parameters[axes::software_limit_negative]};
        }
        return Reading::valid();
    }
    void clear() noexcept { LimitValues = {}; }
};

/// At rest. All members or none; every path after it is looked at along its whole length with them. They hold for homed axes, and are the axes'
/// parameters.
struct MC_GroupWriteSWLimits : GroupSettingBlock<MC_GroupWriteSWLimits> {
    GroupRef AxesGroup{};
    bool Execute = false;
    MC_GROUP_SWLIMITS LimitValues{};
    MC_ExecutionMode ExecutionMode = mcImmediately;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Writes the software limits of all members, or of none.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(),
                         in<&Self::LimitValues>("", "u, of each member by IdentInGroup; infinite = stays as it is"),
                         in<&Self::ExecutionMode>("", "mcImmediately; no other yet"), out<&Self::Done>("", "all of them hold"),
                         grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] ErrorId refuse() const noexcept { return ExecutionMode == mcImmediately ? ErrorId::none : ErrorId::not_supported; }
    [[nodiscard]] axes::GroupSetting setting() const noexcept {
        axes::WriteSoftwareLimits limits;
        for (std::size_t i = 0; i < axes::most_members; ++i) {
            limits.high[i] = LimitValues.Axes[i].SWLimitPos;
            limits.low[i] = LimitValues.Axes[i].SWLimitNeg;
        }
        return limits;
    }
};

}  // namespace taktwerk::fb
