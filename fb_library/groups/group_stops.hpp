#pragma once
// MC_GroupStop, MC_GroupHalt, MC_GroupInterrupt, MC_GroupContinue, MC_GroupSetOverride: PLCopen Part 4 v2.0. All of them act along the path, which none of
// them leaves. Real-time safe.

#include <string_view>

#include "fb_library/groups/group_block.hpp"

namespace taktwerk::fb {

struct MC_GroupStop : GroupCommandBlock<MC_GroupStop> {
    GroupRef AxesGroup{};
    bool Execute = false;
    double Deceleration = 0, Jerk = 0;

    bool Done = false, Busy = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Stops the group on its path, ends all its commands and locks it while Execute is TRUE.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup>(), in<&Self::Execute>("", "a rising edge stops; the group stays locked while TRUE"),
                         grouped<&Self::Deceleration, &Self::Jerk>(), out<&Self::Done>("", "the path velocity is zero"),
                         grouped<&Self::Busy>(), out<&Self::CommandAborted>("", "the group was disabled"),
                         grouped<&Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept {
        return {.kind = axes::GroupCommandKind::stop, .dynamics = {0, 0, Deceleration, Jerk}};
    }

private:
    friend ExecuteBlock<MC_GroupStop>;
    /// Also during the ramp: the group keeps the lock until it stands.
    void released(const MotionContext& ctx) noexcept {
        if (core_.command() != 0 && ctx.groups != nullptr) ctx.groups->release_stop(group_, core_.command(), ctx.owner);
    }
};

struct MC_GroupHalt : GroupCommandBlock<MC_GroupHalt> {
    GroupRef AxesGroup{};
    bool Execute = false;
    double Deceleration = 0, Jerk = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAccepted = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    CommandNumber CommandID{};

    static constexpr std::string_view summary = "Brings the group to standstill on its path; any other command may take over meanwhile.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute, &Self::Deceleration, &Self::Jerk, &Self::BufferMode>(),
                         out<&Self::Done>("", "the path velocity is zero"),
                         grouped<&Self::Busy, &Self::Active, &Self::CommandAccepted, &Self::CommandAborted, &Self::Error, &Self::ErrorID,
                                 &Self::CommandID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept {
        return {.kind = axes::GroupCommandKind::halt, .buffer_mode = BufferMode, .dynamics = {0, 0, Deceleration, Jerk}};
    }
};

/// The interrupted command stays Busy, and goes on by MC_GroupContinue.
struct MC_GroupInterrupt : GroupCommandBlock<MC_GroupInterrupt> {
    GroupRef AxesGroup{};
    bool Execute = false;
    double Deceleration = 0, Jerk = 0;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Stops the group on its path and keeps its commands.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute, &Self::Deceleration, &Self::Jerk>(),
                         out<&Self::Done>("", "the group stands and can go on"), grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept {
        return {.kind = axes::GroupCommandKind::interrupt, .dynamics = {0, 0, Deceleration, Jerk}};
    }
};

/// From where the path was interrupted.
struct MC_GroupContinue : GroupCommandBlock<MC_GroupContinue> {
    GroupRef AxesGroup{};
    bool Execute = false;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Goes on with what MC_GroupInterrupt has interrupted.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(), out<&Self::Done>("", "the group goes on"),
                         grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept { return {.kind = axes::GroupCommandKind::resume}; }
};

/// Writes the factors while Enable is TRUE; the last ones stay when it falls.
struct MC_GroupSetOverride {
    using Self = MC_GroupSetOverride;
    GroupRef AxesGroup{};
    bool Enable = false;
    double VelFactor = 1, AccFactor = 1, JerkFactor = 1;

    bool Enabled = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    EnableCore core{};  ///< not a pin

    static constexpr std::string_view summary = "Scales velocity, acceleration and jerk along the path; the path stays as it is.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), in<&Self::VelFactor>("1", "0 to 1; 0 holds on the path; default 1"),
                         in<&Self::AccFactor>("1", "above 0 to 1, on acceleration and deceleration; default 1"),
                         in<&Self::JerkFactor>("1", "above 0 to 1; default 1"), out<&Self::Enabled>("", "the group has these factors"),
                         grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    void operator()(const MotionContext& ctx) noexcept {
        (void)core.begin(Enable);
        if (core.working()) core.took(write(ctx));
        core.publish(*this);
    }
    void warm_start(Instant) noexcept {}

private:
    [[nodiscard]] Reading write(const MotionContext& ctx) const noexcept {
        const axes::GroupView* view = view_of(ctx, AxesGroup);
        if (view == nullptr) return Reading::unless(ErrorId::invalid_group);
        const axes::Override wanted{VelFactor, AccFactor, JerkFactor};
        if (view->override_factors == wanted) return Reading::valid();
        return Reading::unless(ctx.groups->set(AxesGroup, wanted, ctx.owner));
    }
};

}  // namespace taktwerk::fb
