#pragma once
// An axis that follows the length of a group's path, MC_SyncAxisToGroup, and a group whose path's length follows an axis, MC_SyncGroupToAxis. PLCopen Part 4
// v2.0. Real-time safe.

#include <cstdint>
#include <string_view>

#include "fb_library/groups/group_block.hpp"

namespace taktwerk::fb {

/// Goes on until the slave gets another command.
struct MC_SyncAxisToGroup : ExecuteBlock<MC_SyncAxisToGroup> {
    GroupRef AxesGroup{};
    AxisRef SlaveAxis{};
    bool Execute = false;
    std::int16_t RatioNumerator = 1;
    std::uint16_t RatioDenominator = 1;
    double Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    bool InSync = false;

    static constexpr std::string_view summary = "Lets an axis follow the length of a group's path.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            grouped<&Self::AxesGroup>(), in_out<&Self::SlaveAxis>("", "following axis; no member of the group"), grouped<&Self::Execute>(),
            in<&Self::RatioNumerator>("", "u of the slave ..."), in<&Self::RatioDenominator>("", "... for so many u of the path; not 0"),
            in<&Self::Acceleration>("u/s2", "until in sync; 0 or less = the slave's limit"), in<&Self::Deceleration>("u/s2", "likewise"),
            in<&Self::Jerk>("u/s3", "likewise"), in<&Self::BufferMode>("", "mcAborting"), grouped<&Self::Busy>(),
            out<&Self::Active>("", "this command controls the slave"),
            out<&Self::CommandAborted>("", "another command of the slave took over"), grouped<&Self::Error, &Self::ErrorID>(),
            out<&Self::InSync>("", "in the ratio, and locked by place"));
    }
    [[nodiscard]] AxisRef acted_on() const noexcept { return SlaveAxis; }
    void show(const MotionContext& ctx) noexcept {
        const axes::PathSlave* slave = this->core_.active() ? slave_of(ctx) : nullptr;
        InSync = slave != nullptr && slave->id == id_ && slave->in_sync;
    }

private:
    friend ExecuteBlock<MC_SyncAxisToGroup>;
    [[nodiscard]] const axes::PathSlave* slave_of(const MotionContext& ctx) const noexcept {
        const axes::GroupView* view = view_of(ctx, group_);
        if (view == nullptr) return nullptr;
        for (const auto& slave : view->slaves)
            if (slave.id != 0 && slave.axis == axis_) return &slave;
        return nullptr;
    }
    void start(const MotionContext& ctx) noexcept {
        if (view_of(ctx, AxesGroup) == nullptr) return this->core_.refuse(ErrorId::invalid_group);
        if (BufferMode != mcAborting) return this->core_.refuse(ErrorId::buffer_mode_not_supported);
        const axes::FollowPath wanted{SlaveAxis, RatioNumerator, RatioDenominator, Acceleration, Deceleration, Jerk, &this->core_};
        const auto error = ctx.groups->set(AxesGroup, wanted, ctx.owner);
        if (error != ErrorId::none) return this->core_.refuse(error);
        group_ = AxesGroup;
        axis_ = SlaveAxis;
        const axes::PathSlave* slave = slave_of(ctx);
        id_ = slave != nullptr ? slave->id : 0;
        this->core_.accepted(id_);
    }
    void follow(const MotionContext& ctx) noexcept {
        const axes::AxisView* view = ctx.view(axis_);
        if (view == nullptr) return this->core_.refuse(ErrorId::invalid_axis);
        this->core_.follow_in(*view, Completion::done);
    }

    GroupRef group_{};  // of the last accepted start
    AxisRef axis_{};
    axes::CommandId id_ = 0;
};

/// Goes on until the group gets another command.
struct MC_SyncGroupToAxis : GroupCommandBlock<MC_SyncGroupToAxis> {
    GroupRef AxesGroup{};
    AxisRef Master{};
    MC_PATH_DATA_REF PathData{};
    bool Execute = false;
    MC_PATH_SYNC_MODE Mode = mcNonPeriodic;
    std::int16_t TuCNumerator = 1;
    std::uint16_t TuCDenominator = 1;
    double Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_CoordSystem CoordSystem = mcMCS;
    MC_BufferMode BufferMode = mcAborting;

    bool Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    bool InSync = false;

    static constexpr std::string_view summary = "Moves the tool's point along a stored path as an axis moves: on, to a stop and back.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup>(),
                         in_out<&Self::Master>("", "the axis or encoder that drives the path; no member of the group"),
                         in_out<&Self::PathData>("", "from MC_PathSelect; one that stands nowhere"), grouped<&Self::Execute>(),
                         in<&Self::Mode>("", "mcNonPeriodic: stands at the path's ends; mcPeriodic: goes on from its end to its beginning"),
                         in<&Self::TuCNumerator>("", "u of the master ..."),
                         in<&Self::TuCDenominator>("", "... for so many u of the path; neither is 0"),
                         in<&Self::Acceleration>("u/s2", "until in sync; 0 or less = the group's default, what the path leaves at most"),
                         in<&Self::Deceleration>("u/s2", "likewise"), in<&Self::Jerk>("u/s3", "likewise"), grouped<&Self::CoordSystem>(),
                         in<&Self::BufferMode>("", "mcAborting, mcBuffered"),
                         grouped<&Self::Busy, &Self::Active, &Self::CommandAborted, &Self::Error, &Self::ErrorID>(),
                         out<&Self::InSync>("", "the path's length is locked to the master by place"));
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept {
        axes::GroupCommand command{.kind = axes::GroupCommandKind::driven_path, .frame = CoordSystem, .buffer_mode = BufferMode};
        command.dynamics = {0, Acceleration, Deceleration, Jerk};
        command.path = PathData.path;
        command.ticket = PathData.ticket;
        command.driver = {Master, TuCNumerator, TuCDenominator, Mode};
        return command;
    }
    void show(const MotionContext& ctx) noexcept {
        const axes::GroupView* view = this->core_.active() ? view_of(ctx, group_) : nullptr;
        InSync = view != nullptr && view->driver.in_sync;
    }
};

}  // namespace taktwerk::fb
