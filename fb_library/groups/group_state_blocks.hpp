#pragma once
// How a group is: MC_GroupReadStatus, MC_GroupReadMotionState, MC_GroupReadError, MC_GroupReadCommandInfo, MC_GroupReadConfiguration,
// MC_ReadAxisGroupInfo. PLCopen Part 4 v2.0. Real-time safe. What they give is the group's view; it goes back whenever Valid is FALSE.

#include <cmath>
#include <string_view>

#include "fb_library/groups/group_block.hpp"

namespace taktwerk::fb {

struct MC_GroupReadStatus : GroupReadBlock<MC_GroupReadStatus> {
    GroupRef AxesGroup{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    bool GroupMoving = false, GroupHoming = false, GroupErrorStop = false, GroupStandby = false, GroupStopping = false,
         GroupDisabled = false;

    static constexpr std::string_view summary = "Gives the group's state: exactly one of six outputs is TRUE while Valid.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), reading<Self>(),
                         out<&Self::GroupMoving>("", "the group moves its axes, or waits between two moves"),
                         out<&Self::GroupHoming>("", "MC_GroupHome runs"),
                         out<&Self::GroupErrorStop>("", "stopped by an error; MC_GroupReset leads out"),
                         out<&Self::GroupStandby>("", "enabled, nothing to do"),
                         out<&Self::GroupStopping>("", "MC_GroupStop stops or locks the group"),
                         out<&Self::GroupDisabled>("", "MC_GroupEnable leads out"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        show(view.state);
        return Reading::valid();
    }
    void clear() noexcept { GroupMoving = GroupHoming = GroupErrorStop = GroupStandby = GroupStopping = GroupDisabled = false; }

private:
    void show(axes::GroupState state) noexcept {
        GroupMoving = state == axes::GroupState::GroupMoving;
        GroupHoming = state == axes::GroupState::GroupHoming;
        GroupErrorStop = state == axes::GroupState::GroupErrorStop;
        GroupStandby = state == axes::GroupState::GroupStandby;
        GroupStopping = state == axes::GroupState::GroupStopping;
        GroupDisabled = state == axes::GroupState::GroupDisabled;
    }
};

struct MC_GroupReadMotionState : GroupReadBlock<MC_GroupReadMotionState> {
    GroupRef AxesGroup{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    bool Tracking = false, InSync = false, InPosition = false, Standstill = false, ConstantVelocity = false, Accelerating = false,
         Decelerating = false;
    CommandNumber ActiveCommandID{};

    static constexpr std::string_view summary = "Gives how the group moves along its path.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), reading<Self>(),
                         out<&Self::Tracking>("", "goes with a frame that moves, joins it, or leaves it"),
                         out<&Self::InSync>("", "with a frame that moves"),
                         out<&Self::InPosition>("", "all members are at their set positions"),
                         out<&Self::Standstill>("", "the path velocity is zero, and no member moves; in sync: on the frame"),
                         out<&Self::ConstantVelocity>("", "along the path"), out<&Self::Accelerating>("", "along the path"),
                         out<&Self::Decelerating>("", "along the path"),
                         out<&Self::ActiveCommandID>("", "of the command that controls the group; 0 = none"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        InPosition = view.in_position;
        bool moves = view.path_velocity != 0 || view.path_acceleration != 0;
        for (const double velocity : view.set_velocity) moves = moves || velocity != 0;
        Tracking = view.track.axis.valid();
        InSync = view.track.in_sync;
        Standstill = InSync ? view.path_velocity == 0 && view.path_acceleration == 0 : !moves;
        // A plan comes to its velocity as to a limit: what changes it by less than a twentieth in a second is constant.
        constexpr double constant_share = 0.05;  // 1/s
        ConstantVelocity = view.path_velocity != 0 && std::abs(view.path_acceleration) <= constant_share * view.path_velocity;
        Accelerating = !ConstantVelocity && view.path_acceleration > 0;
        Decelerating = !ConstantVelocity && view.path_acceleration < 0;
        ActiveCommandID = {view.active};
        return Reading::valid();
    }
    void clear() noexcept {
        Tracking = InSync = InPosition = Standstill = ConstantVelocity = Accelerating = Decelerating = false;
        ActiveCommandID = {};
    }
};

/// A refused command is no error of the group.
struct MC_GroupReadError : GroupReadBlock<MC_GroupReadError> {
    GroupRef AxesGroup{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    std::uint16_t GroupErrorID = 0;

    static constexpr std::string_view summary = "Gives the error that led the group to GroupErrorStop, until it is reset.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), reading<Self>(),
                         out<&Self::GroupErrorID>("", "alarm id of a member, or an ErrorID; 0 = none"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        GroupErrorID = view.error;
        return Reading::valid();
    }
    void clear() noexcept { GroupErrorID = 0; }
};

/// Error unknown_command once the command is over.
struct MC_GroupReadCommandInfo : GroupReadBlock<MC_GroupReadCommandInfo> {
    GroupRef AxesGroup{};
    bool Enable = false;
    CommandNumber CommandID{};

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    MC_CommandState CommandState = mcAccepted;
    Duration ElapsedDuration{}, RemainingDuration{};
    double RemainingDistance = 0, Progress = 0;
    std::uint16_t InfoID = 0, WarningID = 0;

    static constexpr std::string_view summary = "Gives how far a command of the group has come.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            grouped<&Self::AxesGroup, &Self::Enable>(), in<&Self::CommandID>("", "as the command's block gave it"), reading<Self>(),
            out<&Self::CommandState>("", "waits or is under way"), out<&Self::ElapsedDuration>("", "since it became active"),
            out<&Self::RemainingDuration>("", "as planned now; 0 where nobody can say"),
            out<&Self::RemainingDistance>("u", "of the set-point to the command's end"), out<&Self::Progress>("1", "of its way, 0 to 1"),
            out<&Self::InfoID>("", "always 0"), out<&Self::WarningID>("", "always 0"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        clear();
        bool waits = false;
        for (std::uint8_t i = 0; i < view.queued_count; ++i) waits = waits || view.queued[i] == CommandID.id;
        const bool active = CommandID.id != 0 && view.active == CommandID.id;
        if (!active && !(waits && CommandID.id != 0)) return Reading::unless(ErrorId::unknown_command);
        if (!active) return Reading::valid();
        CommandState = view.status(CommandID.id) == axes::CommandStatus::active ? mcActive : mcAccepted;
        ElapsedDuration = view.elapsed;
        RemainingDuration = view.remaining;
        RemainingDistance = view.remaining_distance;
        Progress = view.progress;
        return Reading::valid();
    }
    void clear() noexcept {
        CommandState = mcAccepted;
        ElapsedDuration = RemainingDuration = {};
        RemainingDistance = Progress = 0;
    }
};

/// ACS only: the machine's other frames have no axes here.
struct MC_GroupReadConfiguration : GroupReadBlock<MC_GroupReadConfiguration> {
    GroupRef AxesGroup{};
    bool Enable = false;
    fb::IdentInGroup IdentInGroup{};
    MC_CoordSystem CoordSystem = mcACS;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    AxisRef Axis{};
    AxisNumber AxisID{};

    static constexpr std::string_view summary = "Gives the axis behind an identifier.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable, &Self::IdentInGroup>(), in<&Self::CoordSystem>("", "mcACS"),
                         reading<Self>(), out<&Self::Axis>("", "the member"),
                         out<&Self::AxisID>("", "its number in the configuration, from 1 on"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        clear();
        if (CoordSystem != mcACS) return Reading::unless(ErrorId::not_supported);
        const auto place = static_cast<std::size_t>(IdentInGroup - 1);
        if (!view.has(place)) return Reading::unless(ErrorId::invalid_member);
        Axis = view.members[place];
        AxisID = {static_cast<std::uint16_t>(Axis.index + 1)};
        return Reading::valid();
    }
    void clear() noexcept {
        Axis = {};
        AxisID = {};
    }
};

/// Error invalid_member of an axis that is in no group.
struct MC_ReadAxisGroupInfo : EnableBlock<MC_ReadAxisGroupInfo> {
    AxisRef Axis{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    GroupRef AxesGroup{};
    GroupNumber AxesGroupID{};
    fb::IdentInGroup IdentInGroup{};

    static constexpr std::string_view summary = "Gives the group that an axis is in.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis>(), grouped<&Self::Enable>(), reading<Self>(), out<&Self::AxesGroup>("", "the group"),
                         out<&Self::AxesGroupID>("", "its number in the configuration, from 1 on"),
                         out<&Self::IdentInGroup>("", "which member the axis is"));
    }
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        clear();
        if (ctx.view(Axis) == nullptr) return Reading::unless(ErrorId::invalid_axis);
        if (ctx.groups == nullptr) return Reading::unless(ErrorId::invalid_group);
        const auto group = ctx.groups->group_of(Axis);
        const auto* view = ctx.groups->view(group);
        if (view == nullptr) return Reading::unless(ErrorId::invalid_member);
        AxesGroup = group;
        AxesGroupID = {static_cast<std::uint16_t>(group.index + 1)};
        for (std::size_t i = 0; i < axes::most_members; ++i)
            if (view->members[i] == Axis) IdentInGroup = {static_cast<std::uint8_t>(i + 1)};
        return Reading::valid();
    }
    void clear() noexcept {
        AxesGroup = {};
        AxesGroupID = {};
        IdentInGroup = {};
    }
};

}  // namespace taktwerk::fb
