#pragma once
// What all parts of an axis read: what it is, what is asked of it, and how it stands with the standard's states. Nothing here decides.

#include <cstdint>

#include "axes/axis/alarm_board.hpp"
#include "axes/axis/axis_config.hpp"
#include "axes/axis/command_queue.hpp"
#include "axes/axis/holding_brake.hpp"
#include "axes/axis/motion_scene.hpp"
#include "axes/axis/operating_mode.hpp"
#include "axes/axis/power_sequence.hpp"
#include "axes/axis/units.hpp"
#include "axes/port/drive_port.hpp"

namespace taktwerk::axes {

struct AxisBody {
    AxisBody(AxisConfig as_configured, DrivePort& drive, Duration period, std::uint16_t place, const AxisView& view);

    AxisConfig config;  ///< its limits, windows and speeds as they hold now: parameters change them, never above what was configured
    MotionScene scene;
    CommandQueue queue;
    AlarmBoard alarms;
    HoldingBrake brake;

    // What every cycle reads lies side by side from here on, and Measured behind it.
    DrivePort& port;
    const AxisView& shown;  ///< what everybody saw last: some of what comes next waits until it was seen
    Duration cycle;
    Instant now{};
    AxisUnits units;
    PowerSequence power;
    CommandId lock = 0;  ///< the MC_Stop that holds the axis in Stopping; 0: none
    std::uint16_t index;
    std::uint16_t error = 0;       ///< alarm that holds the axis in ErrorStop; 0: none
    std::uint8_t power_calls = 0;  ///< of MC_Power in this cycle: its holder speaks once in it
    bool driven;                   ///< has a drive that may be enabled
    bool endless;                  ///< has no software limits
    bool slow_line;                ///< its drive takes no set-point in each cycle, and makes its own ramps
    AxisState state = AxisState::Disabled;
    Owner owner = Owner::program;
    bool homed = false;
    bool homing_procedure = false;  ///< between the first step of Part 5 and MC_FinishHoming
    bool begin_pending = false;     ///< the active command has not been turned into a goal yet

    // what is wanted of it
    OperatingMode mode = OperatingMode::automatic;
    EmergencyStop emergency = EmergencyStop::none;
    Presence presence = Presence::always;
    bool power_wish = false, permit_positive = true, permit_negative = true;

    /// From a word to its effect as the feedback shows it, where that is more than a bus' few cycles.
    [[nodiscard]] Duration round_trip() const noexcept { return port.capabilities().command_latency + port.capabilities().feedback_period; }
    /// Nobody's axis goes to the first who asks.
    [[nodiscard]] bool may(Owner who) noexcept {
        if (owner == Owner::none) owner = who;
        return who == owner;
    }
    /// Its set-points come from its group: nobody else moves it.
    [[nodiscard]] bool led() const noexcept { return queue.active().command.kind == CommandKind::group_motion; }
    [[nodiscard]] bool software_limits_hold() const noexcept { return homed && config.modulo == 0; }
    /// u/s, of the operating mode; infinity: none.
    [[nodiscard]] double velocity_cap() const noexcept;
    /// The way in the sense of `velocity` is not permitted by whoever gave power.
    [[nodiscard]] bool barred(double velocity) const noexcept { return velocity > 0 ? !permit_positive : velocity < 0 && !permit_negative; }
};

}  // namespace taktwerk::axes
