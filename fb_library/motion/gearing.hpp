#pragma once
// MC_GearIn, MC_GearOut, MC_GearInPos: PLCopen Part 1 v2.0, 4.5 to 4.7. Real-time safe.
//
// The slave is the axis acted on; the master never notices.

#include <string_view>

#include "fb_library/motion/execute_block.hpp"
#include "fb_library/motion/gear_ratio.hpp"

namespace taktwerk::fb {

struct MC_GearIn : CommandBlock<MC_GearIn> {
    AxisRef Master{}, Slave{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    std::int32_t RatioNumerator = 1;
    std::uint32_t RatioDenominator = 1;
    MC_Source MasterValueSource = mcSetValue;
    double Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool InGear = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::gear_in;
    static constexpr bool MC_GearIn::*in_target_pin = &MC_GearIn::InGear;
    static constexpr std::string_view summary = "Couples the slave's velocity to the master's by a ratio.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Master, &Self::Slave, &Self::Execute, &Self::ContinuousUpdate>(),
                         in<&Self::RatioNumerator>("", "slave's part of the ratio, signed; default 1"),
                         in<&Self::RatioDenominator>("", "master's part of the ratio, > 0; default 1"),
                         in<&Self::MasterValueSource>("", "set or actual value of the master"),
                         shared<&Self::Acceleration, &Self::Deceleration, &Self::Jerk, &Self::BufferMode>(),
                         out<&Self::InGear>("", "the slave has the ratio's velocity"), outcome<Self>());
    }

    [[nodiscard]] axes::GearDetails details() const noexcept {
        return {Master, gear_ratio(RatioNumerator, RatioDenominator), MasterValueSource};
    }
};

struct MC_GearOut : CommandBlock<MC_GearOut> {
    AxisRef Slave{};
    bool Execute = false;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::gear_out;
    static constexpr std::string_view summary = "Releases the slave from its gear; it goes on with the velocity it has.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Slave, &Self::Execute>(), out<&Self::Done>("", "the slave is free"), outcome<Self>());
    }
};

/// StartSync is TRUE from the moment the slave begins to synchronise until InSync.
struct MC_GearInPos : CommandBlock<MC_GearInPos> {
    AxisRef Master{}, Slave{};
    bool Execute = false;
    std::int32_t RatioNumerator = 1;
    std::uint32_t RatioDenominator = 1;
    MC_Source MasterValueSource = mcSetValue;
    double MasterSyncPosition = 0, SlaveSyncPosition = 0;
    MC_SyncMode SyncMode = mcShortest;
    double MasterStartDistance = 0, Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool StartSync = false, InSync = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::gear_in_pos;
    static constexpr bool MC_GearInPos::*in_target_pin = &MC_GearInPos::InSync;
    static constexpr std::string_view summary = "Couples the slave's position to the master's from a pair of positions on.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            shared<&Self::Master, &Self::Slave, &Self::Execute>(),
            in<&Self::RatioNumerator>("", "slave's part of the ratio, signed; default 1"),
            in<&Self::RatioDenominator>("", "master's part of the ratio, > 0; default 1"),
            in<&Self::MasterValueSource>("", "set or actual value of the master"),
            in<&Self::MasterSyncPosition>("u of master", "where the master is when the slave is in sync"),
            in<&Self::SlaveSyncPosition>("u", "where the slave is then"), in<&Self::SyncMode>("", "which way a modulo slave takes"),
            in<&Self::MasterStartDistance>("u of master", "before the sync position; there the slave begins. 0 = at once"),
            in<&Self::Velocity>("u/s", "limit until InSync; 0 = the axis' limit"), shared<&Self::Acceleration, &Self::Deceleration>(),
            in<&Self::Jerk>("u/s3", "most on the way to the sync point; 0 = no limit"), shared<&Self::BufferMode>(),
            out<&Self::StartSync>("", "the slave is on its way into sync"),
            out<&Self::InSync>("", "the slave has the position of the gear"), outcome<Self>());
    }

    [[nodiscard]] axes::GearInPosDetails details() const noexcept {
        return {Master,
                gear_ratio(RatioNumerator, RatioDenominator),
                MasterValueSource,
                SyncMode,
                MasterSyncPosition,
                SlaveSyncPosition,
                MasterStartDistance};
    }
    void show(const MotionContext& ctx) noexcept {
        const axes::AxisView* view = ctx.view(core_.axis());
        StartSync = Active && !InSync && view != nullptr && view->sync_started;
    }
};

}  // namespace taktwerk::fb
