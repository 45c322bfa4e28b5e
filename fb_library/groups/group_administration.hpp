#pragma once
// Members, enabling, power and reset of a group: MC_AddAxisToGroup, MC_RemoveAxisFromGroup, MC_UngroupAllAxes, MC_GroupEnable, MC_GroupDisable,
// MC_GroupPower, MC_GroupReset. PLCopen Part 4 v2.0. Real-time safe.

#include <string_view>

#include "fb_library/groups/group_block.hpp"

namespace taktwerk::fb {

/// In GroupDisabled only.
struct MC_AddAxisToGroup : GroupSettingBlock<MC_AddAxisToGroup> {
    GroupRef AxesGroup{};
    AxisRef Axis{};
    bool Execute = false;
    fb::IdentInGroup IdentInGroup{};

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Makes an axis a member of a disabled group.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup>(), shared<&Self::Axis>(), grouped<&Self::Execute, &Self::IdentInGroup>(),
                         out<&Self::Done>("", "the axis is a member"), grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupSetting setting() const noexcept { return axes::AddMember{Axis, IdentInGroup}; }
};

/// In GroupDisabled only.
struct MC_RemoveAxisFromGroup : GroupSettingBlock<MC_RemoveAxisFromGroup> {
    GroupRef AxesGroup{};
    bool Execute = false;
    fb::IdentInGroup IdentInGroup{};

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Takes a member out of a disabled group.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute, &Self::IdentInGroup>(), out<&Self::Done>("", "the axis is free"),
                         grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupSetting setting() const noexcept { return axes::RemoveMember{IdentInGroup}; }
};

/// From GroupDisabled, GroupStandby and GroupErrorStop; not in motion.
struct MC_UngroupAllAxes : GroupSettingBlock<MC_UngroupAllAxes> {
    GroupRef AxesGroup{};
    bool Execute = false;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Takes all members out of a group, which is disabled then.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(), out<&Self::Done>("", "the group is empty and disabled"),
                         grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupSetting setting() const noexcept { return axes::RemoveAllMembers{}; }
};

/// Powers nothing: MC_GroupPower or MC_Power.
struct MC_GroupEnable : GroupSettingBlock<MC_GroupEnable> {
    GroupRef AxesGroup{};
    bool Execute = false;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Leads a group from GroupDisabled to GroupStandby.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(), out<&Self::Done>("", "the group is enabled"),
                         grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupSetting setting() const noexcept { return axes::EnableGroup{}; }
};

/// A moving group stops on its path first. An error of the group is kept.
struct MC_GroupDisable : GroupCommandBlock<MC_GroupDisable> {
    GroupRef AxesGroup{};
    bool Execute = false;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Ends all commands of a group and leads it to GroupDisabled.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(), out<&Self::Done>("", "the group is disabled"),
                         grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept { return {.kind = axes::GroupCommandKind::disable}; }
};

/// MC_Power of every member: the same rules, axis by axis; a second holder of one of them gets power_conflict.
struct MC_GroupPower {
    using Self = MC_GroupPower;
    GroupRef AxesGroup{};
    bool Enable = false;

    bool Status = false, Valid = false, Error = false;
    ErrorId ErrorID{};

    EnableCore core{};                               ///< not a pin
    GroupRef powered_group{};                        ///< not a pin: of the rising edge
    std::array<AxisRef, axes::most_members> held{};  ///< not a pin: whom it keeps on; one that leaves the group meanwhile is let go

    static constexpr std::string_view summary = "Switches the power stages of all members on and off.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup>(), in<&Self::Enable>("", "power stages on while TRUE"),
                         out<&Self::Status>("", "the power stages of all members are on"),
                         out<&Self::Valid>("", "Enable is TRUE and all members take the wish"), grouped<&Self::Error, &Self::ErrorID>());
    }

    void operator()(const MotionContext& ctx) noexcept {
        const auto edge = core.begin(Enable);
        if (edge == EnableCore::Edge::rising) powered_group = AxesGroup;
        const bool ends = edge == EnableCore::Edge::falling;
        const axes::GroupView* view = view_of(ctx, Enable || ends ? powered_group : AxesGroup);
        for (std::size_t i = 0; i < held.size(); ++i) {
            const bool stays = Enable && view != nullptr && view->has(i) && view->members[i] == held[i];
            if (!held[i].valid() || stays) continue;
            (void)ctx.requests->power(held[i], false, false, false, ctx.owner);
            held[i] = {};
        }
        if (view == nullptr) {
            if (Enable) core.took(Reading::unless(ErrorId::invalid_group));
        } else if (Enable || ends) {
            auto error = view->member_count > 0 ? ErrorId::none : ErrorId::no_members;
            for (std::size_t i = 0; i < axes::most_members; ++i) {
                if (!view->has(i)) continue;
                const auto refused = ctx.requests->power(view->members[i], Enable, Enable, Enable, ctx.owner);
                if (Enable && refused == ErrorId::none) held[i] = view->members[i];
                if (error == ErrorId::none) error = refused;
            }
            if (Enable) core.took(Reading::unless(error));
        }
        Status = view != nullptr && view->powered;
        core.publish(*this);
    }
    void warm_start(Instant) noexcept {}
};

/// Out of GroupErrorStop, with all members that are in ErrorStop. Outside it Done at once.
struct MC_GroupReset : ExecuteBlock<MC_GroupReset> {
    GroupRef AxesGroup{};
    bool Execute = false;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    Instant started{};  ///< not a pin
    GroupRef group{};   ///< not a pin

    /// Longer than an axis waits for its drive to acknowledge.
    static constexpr Duration patience = std::chrono::seconds{10};

    static constexpr std::string_view summary = "Clears the errors of a group and its members: from GroupErrorStop to GroupStandby.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(), out<&Self::Done>("", "the group is not in GroupErrorStop (any more)"),
                         grouped<&Self::Busy>(), out<&Self::Error>("", "refused, or a member cannot be reset"), grouped<&Self::ErrorID>());
    }

private:
    friend ExecuteBlock<MC_GroupReset>;
    void start(const MotionContext& ctx) noexcept {
        if (view_of(ctx, AxesGroup) == nullptr) return core_.refuse(ErrorId::invalid_group);
        if (const auto error = ctx.groups->reset(AxesGroup, ctx.owner); error != ErrorId::none) return core_.refuse(error);
        core_.start({});
        started = ctx.now;
        group = AxesGroup;
    }
    void follow(const MotionContext& ctx) noexcept {
        const axes::GroupView* view = view_of(ctx, group);
        if (view == nullptr) return core_.refuse(ErrorId::invalid_group);
        if (view->state != axes::GroupState::GroupErrorStop) return core_.finish();
        if (!view->resetting) return core_.refuse(view->reset_error != ErrorId::none ? view->reset_error : ErrorId::reset_failed);
        if (ctx.now - started >= patience) core_.refuse(ErrorId::reset_failed);
    }
};

}  // namespace taktwerk::fb
