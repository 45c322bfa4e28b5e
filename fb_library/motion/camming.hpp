#pragma once
// MC_CamTableSelect, MC_CamIn, MC_CamOut: PLCopen Part 1 v2.0, 4.2 to 4.4. Real-time safe.
//
// MC_CamTableSelect makes a prepared copy of a declared cam and gives its id; MC_CamIn follows the copy. What is edited in the cam
// afterwards counts from the next MC_CamTableSelect on.

#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

/// Acts through Slave, or through Master when Slave names no axis. The id is the one of this block's own selection: when another block
/// selects through the same axis in the same scan, the later call is served first and this one asks again.
struct MC_CamTableSelect : SettingBlock<MC_CamTableSelect> {
    AxisRef Master{}, Slave{};
    CamRef CamTable{};
    bool Execute = false;
    bool Periodic = false, MasterAbsolute = false, SlaveAbsolute = false;
    MC_ExecutionMode ExecutionMode = mcImmediately;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    CamId CamTableID{};

    static constexpr std::string_view summary = "Checks a cam and prepares it for MC_CamIn.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Master, &Self::Slave>(), in_out<&Self::CamTable>("", "a declared cam"), shared<&Self::Execute>(),
                         in<&Self::Periodic>("", "repeats without end; FALSE: runs once"),
                         in<&Self::MasterAbsolute>("", "master positions are the axis' own; FALSE: from where it is at the start"),
                         in<&Self::SlaveAbsolute>("", "slave positions are the axis' own; FALSE: from where it is at the start"),
                         shared<&Self::ExecutionMode>(), out<&Self::Done>("", "CamTableID may be used"), outcome<Self>(),
                         out<&Self::CamTableID>("", "for MC_CamIn; stays until the next selection is done"));
    }

    [[nodiscard]] axes::SelectCam setting() const noexcept { return {CamTable, Periodic, MasterAbsolute, SlaveAbsolute}; }
    [[nodiscard]] AxisRef acted_on() const noexcept { return Slave.valid() ? Slave : Master; }

    axes::SelectCam wanted{};  ///< of the edge; not a pin

private:
    using Base = SettingBlock<MC_CamTableSelect>;
    friend ExecuteBlock<MC_CamTableSelect>;
    void start(const MotionContext& ctx) noexcept {
        wanted = setting();
        Base::start(ctx);
    }
    void follow(const MotionContext& ctx) noexcept {
        Base::follow(ctx);
        if (!core_.done()) return;
        const axes::AxisView* view = ctx.view(core_.axis());
        if (view->selected_as == wanted) CamTableID = view->selected_cam;
        else set_at_once(ctx, core_.axis(), wanted);
    }
};

/// EndOfProfile is TRUE for one call at each end of the profile, also in reverse, while the block is Active.
struct MC_CamIn : CommandBlock<MC_CamIn> {
    AxisRef Master{}, Slave{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    double MasterOffset = 0, SlaveOffset = 0, MasterScaling = 1, SlaveScaling = 1, MasterStartDistance = 0, MasterSyncPosition = 0;
    MC_StartMode StartMode = mcAbsolute;
    MC_Source MasterValueSource = mcSetValue;
    CamId CamTableID{};
    MC_BufferMode BufferMode = mcAborting;

    bool InSync = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    bool EndOfProfile = false;

    std::uint32_t ends = 0;   ///< of the axis' cams, as last seen; not a pin
    bool was_active = false;  ///< not a pin

    static constexpr auto kind = axes::CommandKind::cam_in;
    static constexpr bool MC_CamIn::*in_target_pin = &MC_CamIn::InSync;
    static constexpr std::string_view summary = "Couples the slave's position to the master's by a cam.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Master, &Self::Slave, &Self::Execute, &Self::ContinuousUpdate>(),
                         in<&Self::MasterOffset>("u of master", "shift of the cam along the master"),
                         in<&Self::SlaveOffset>("u", "shift of the cam along the slave"),
                         in<&Self::MasterScaling>("1", "factor on the cam's master positions, not 0; default 1"),
                         in<&Self::SlaveScaling>("1", "factor on the cam's slave positions; default 1"),
                         in<&Self::MasterStartDistance>("u of master", "before the sync position; there the slave begins. 0 = at once"),
                         in<&Self::MasterSyncPosition>("u of master", "in the profile: where the slave is in sync, after a start distance"),
                         in<&Self::StartMode>("", "absolute, from where the slave is, or with a ramp"),
                         in<&Self::MasterValueSource>("", "set or actual value of the master"),
                         in<&Self::CamTableID>("", "of MC_CamTableSelect"), shared<&Self::BufferMode>(),
                         out<&Self::InSync>("", "the slave is on the cam"), outcome<Self>(),
                         out<&Self::EndOfProfile>("", "one call at each end of the profile"));
    }

    [[nodiscard]] axes::CamDetails details() const noexcept {
        return {Master,      CamTableID,    StartMode,    MasterValueSource,   MasterOffset,
                SlaveOffset, MasterScaling, SlaveScaling, MasterStartDistance, MasterSyncPosition};
    }
    void show(const MotionContext& ctx) noexcept {
        const axes::AxisView* view = ctx.view(core_.axis());
        if (view == nullptr) return;
        // An end in the cycle in which this cam began was that of the one before.
        EndOfProfile = Active && was_active && view->cam_ends != ends;
        ends = view->cam_ends;
        was_active = Active;
    }
};

struct MC_CamOut : CommandBlock<MC_CamOut> {
    AxisRef Slave{};
    bool Execute = false;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::cam_out;
    static constexpr std::string_view summary = "Releases the slave from its cam; it goes on with the velocity it has.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Slave, &Self::Execute>(), out<&Self::Done>("", "the slave is free"), outcome<Self>());
    }
};

}  // namespace taktwerk::fb
