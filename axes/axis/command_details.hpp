#pragma once
// What the kinds of commands need beyond position, velocity and ramps. Values, trivially copyable: the latch of a block's inputs.

#include <cstdint>
#include <limits>
#include <variant>

#include "axes/tables/table_refs.hpp"
#include "axes/words/types.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

/// MC_MoveModulo, with move_absolute on a modulo axis: the position may be beyond the modulo, >= 0. What it is beyond are whole turns on
/// top of the way there, in the sense of that way; the shortest way makes none.
struct WholeTurns {
    friend bool operator==(const WholeTurns&, const WholeTurns&) = default;
};

/// MC_GearIn: the slave's velocity is numerator / denominator times the master's.
struct GearRatio {
    std::int32_t numerator = 1;
    std::int32_t denominator = 1;  ///< not 0
    friend bool operator==(const GearRatio&, const GearRatio&) = default;
};
struct GearDetails {
    AxisRef master;
    GearRatio ratio;
    MC_Source source = mcSetValue;
    friend bool operator==(const GearDetails&, const GearDetails&) = default;
};

/// MC_GearInPos: from MasterSyncPosition on, slave - SlaveSyncPosition = ratio * (master - MasterSyncPosition).
struct GearInPosDetails {
    AxisRef master;
    GearRatio ratio;
    MC_Source source = mcSetValue;
    MC_SyncMode mode = mcShortest;
    double master_sync_position = 0;   ///< u of the master
    double slave_sync_position = 0;    ///< u
    double master_start_distance = 0;  ///< u of the master, signed: crossed in this sense; 0 = begin at once
    friend bool operator==(const GearInPosDetails&, const GearInPosDetails&) = default;
};

/// MC_CamIn.
struct CamDetails {
    AxisRef master;
    CamId table;
    MC_StartMode start = mcAbsolute;
    MC_Source source = mcSetValue;
    double master_offset = 0, slave_offset = 0;    ///< u of master, u
    double master_scaling = 1, slave_scaling = 1;  ///< factors
    double master_start_distance = 0;              ///< u of the master, signed as above; 0 = begin at once
    double master_sync_position = 0;               ///< u of the profile's master, where the slave is in sync after a start distance
    friend bool operator==(const CamDetails&, const CamDetails&) = default;
};

/// MC_CombineAxes: slave = ratio1 * master1 +- ratio2 * master2, as motion from where each is at the start.
struct CombineDetails {
    AxisRef master1, master2;
    GearRatio ratio1, ratio2;
    MC_Source source1 = mcSetValue, source2 = mcSetValue;
    MC_CombineMode mode = mcAddAxes;
    friend bool operator==(const CombineDetails&, const CombineDetails&) = default;
};

/// MC_TorqueControl. The absolute velocity limit is the command's velocity, 0 = the axis' limit.
struct TorqueDetails {
    double torque = 0;  ///< fraction of rated torque, signed; times direction
    double ramp = 0;    ///< 1/s; 0 = at once
    friend bool operator==(const TorqueDetails&, const TorqueDetails&) = default;
};

/// MC_SetTorqueLimit. Magnitudes, fractions of rated torque, in the axis' sense; 0 = as configured.
struct TorqueLimitDetails {
    static constexpr double least = 0.001;  ///< what drives count in: less would be none at all
    double positive = 0, negative = 0;
    friend bool operator==(const TorqueLimitDetails&, const TorqueLimitDetails&) = default;
};

/// MC_PositionProfile, MC_VelocityProfile, MC_AccelerationProfile: value(t) = value_scale * table(t / time_scale) + offset.
struct TimeProfileDetails {
    TimeTableRef table;
    double time_scale = 1;  ///< > 0
    double value_scale = 1;
    double offset = 0;  ///< u, u/s, u/s2
    friend bool operator==(const TimeProfileDetails&, const TimeProfileDetails&) = default;
};

/// MC_TouchProbe; MC_AbortTrigger needs the trigger alone.
struct ProbeDetails {
    TriggerRef trigger;
    CommandId replaces = 0;  ///< a probing command that is given up for this one (a block triggered anew); 0 = none
    bool window_only = false;
    double first = 0, last = 0;  ///< u, inclusive; on a modulo axis first > last means the window over the wrap
    friend bool operator==(const ProbeDetails&, const ProbeDetails&) = default;
};

/// The steps of PLCopen Part 5.
enum class HomingStep : std::uint8_t {
    absolute_switch,
    limit_switch,
    block,
    reference_pulse,
    distance_coded,
    direct,
    absolute,
    finish,
    flying_switch,           ///< passive
    flying_reference_pulse,  ///< passive
};

/// Limits: 0 = none. Velocity, ramps and the distance of `finish` are the command's own.
struct HomingStepDetails {
    HomingStep step = HomingStep::direct;
    MC_HomeDirection direction = MC_HomeDirection::mcPositiveDirection;
    MC_SwitchMode switch_mode = MC_SwitchMode::mcRisingEdge;
    TriggerRef reference{};   ///< the switch or the pulse; `falling`: a switch that is normally closed
    double set_position = 0;  ///< u; NaN: the coordinates stay
    double torque_limit = 0;  ///< fraction of rated torque
    Duration time_limit{};
    double distance_limit = 0;            ///< u
    double detection_velocity_limit = 0;  ///< u/s, block
    Duration detection_velocity_time{};   ///< block
    friend bool operator==(const HomingStepDetails&, const HomingStepDetails&) = default;
};

// --- administrative commands ------------------------------------------------------------------------------------------------
// At once, through AxisRequests::set; or queued behind motion (mcQueued), as a command of the kind `setting`.

/// MC_SetPosition.
struct SetPosition {
    double position = 0;  ///< u
    bool relative = false;
    friend bool operator==(const SetPosition&, const SetPosition&) = default;
};
/// MC_WriteParameter, MC_WriteBoolParameter (0 or 1).
struct WriteParameter {
    std::int32_t number = 0;
    double value = 0;
    friend bool operator==(const WriteParameter&, const WriteParameter&) = default;
};
/// MC_WriteDigitalOutput of an axis' drive.
struct WriteOutput {
    std::int32_t number = 0;  ///< bit
    bool value = false;
    friend bool operator==(const WriteOutput&, const WriteOutput&) = default;
};
/// MC_SetOverride: 0 <= velocity <= 1; 0 < acceleration, jerk <= 1.
struct Override {
    double velocity = 1, acceleration = 1, jerk = 1;
    friend bool operator==(const Override&, const Override&) = default;
};
/// The next set-point of an axis that is fed from outside (CommandKind::external). u, u/s, u/s2.
struct SetpointFeed {
    double position = 0, velocity = 0, acceleration = 0;
    friend bool operator==(const SetpointFeed&, const SetpointFeed&) = default;
};
/// MC_CamTableSelect, through its slave (or master): the id is in AxisView::selected_cam once the setting is done.
struct SelectCam {
    CamRef source;
    bool periodic = false, master_absolute = true, slave_absolute = true;
    friend bool operator==(const SelectCam&, const SelectCam&) = default;
};
/// MC_SetBrake.
struct SetBrake {
    bool release = false;
    friend bool operator==(const SetBrake&, const SetBrake&) = default;
};
using AxisSetting = std::variant<SetPosition, WriteParameter, WriteOutput, Override, SetpointFeed, SelectCam, SetBrake>;

using CommandDetails = std::variant<std::monostate, GearDetails, GearInPosDetails, CamDetails, CombineDetails, TorqueDetails,
                                    TimeProfileDetails, ProbeDetails, HomingStepDetails, AxisSetting, WholeTurns, TorqueLimitDetails>;

}  // namespace taktwerk::axes
