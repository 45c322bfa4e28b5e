#pragma once
// One axis as configured. Unit u is the axis' own (mm, deg, ...). Plain data, checked by check(AxisConfig); config/ fills it.

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "axes/axis/error_reaction.hpp"
#include "axes/axis/load_config.hpp"
#include "axes/homing/coded_marks.hpp"
#include "core/result.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

/// counts = position[u] * counts_numerator / counts_denominator: exact, so that nothing drifts.
struct Gearing {
    std::int64_t counts_per_revolution = 10000;  ///< drive's position counts per motor revolution
    std::int64_t motor_revolutions = 1;          ///< gear: this many motor turns ...
    std::int64_t load_revolutions = 1;           ///< ... for so many load turns
    double feed = 1.0;                           ///< u per load revolution (screw pitch, 360 deg, ...)
    bool inverted = false;

    [[nodiscard]] double counts_per_unit() const noexcept {
        return static_cast<double>(counts_per_revolution) * static_cast<double>(motor_revolutions) /
               (static_cast<double>(load_revolutions) * feed) * (inverted ? -1.0 : 1.0);
    }
};

/// What holds in one direction only, as where a weight helps or hinders; 0 = as in both.
struct DirectionLimits {
    double velocity = 0;      ///< u/s
    double acceleration = 0;  ///< u/s2, while the axis gets faster in this direction
    double deceleration = 0;  ///< u/s2, while it gets slower in it
    double torque = 0;        ///< rated torques, of this sign
};

struct AxisLimits {
    double velocity = 100;                                           ///< u/s, > 0
    double acceleration = 1000;                                      ///< u/s2
    double deceleration = 1000;                                      ///< u/s2
    double jerk = 10000;                                             ///< u/s3; infinity = none
    double stop_deceleration = 0;                                    ///< u/s2 for errors and emergency stop; 0 = deceleration
    double stop_jerk = 0;                                            ///< u/s3; 0 = jerk
    double position_min = -std::numeric_limits<double>::infinity();  ///< software limits, active once homed
    double position_max = std::numeric_limits<double>::infinity();
    double torque = std::numeric_limits<double>::infinity();  ///< rated torques, > 0; infinity = what the drive has
    DirectionLimits positive{}, negative{};                   ///< at most what holds in both

    [[nodiscard]] double velocity_towards(double sense) const noexcept { return lesser(towards(sense).velocity, velocity); }
    [[nodiscard]] double acceleration_towards(double sense) const noexcept { return lesser(towards(sense).acceleration, acceleration); }
    [[nodiscard]] double deceleration_towards(double sense) const noexcept { return lesser(towards(sense).deceleration, deceleration); }
    [[nodiscard]] double torque_towards(double sense) const noexcept { return lesser(towards(sense).torque, torque); }
    /// Motion is not bounded alike in both directions.
    [[nodiscard]] bool differ() const noexcept {
        const auto any = [](const DirectionLimits& l) { return l.velocity > 0 || l.acceleration > 0 || l.deceleration > 0; };
        return any(positive) || any(negative);
    }

private:
    [[nodiscard]] const DirectionLimits& towards(double sense) const noexcept { return sense < 0 ? negative : positive; }
    [[nodiscard]] static double lesser(double own, double both) noexcept { return own > 0 && own < both ? own : both; }
};

/// How a move gets its dynamics when the block says 0.
struct AxisDefaults {
    double acceleration = 0, deceleration = 0, jerk = 0;  ///< 0 = the limit
};

struct FollowingErrorWatch {
    double window = std::numeric_limits<double>::infinity();  ///< u
    Duration time = std::chrono::milliseconds{10};            ///< beyond the window for this long: alarm
    Duration per_velocity{};                                  ///< the window is wider by the set velocity times this

    static constexpr Duration most_per_velocity = std::chrono::seconds{10};
};

struct PositionWindows {
    double in_position = 0.01;  ///< u
    Duration in_position_time = std::chrono::milliseconds{10};
    double standstill_velocity = 0.1;  ///< u/s
};

enum class HomingKind : std::uint8_t {
    none,             ///< MC_Home is refused
    drive,            ///< the drive's own method (6098h)
    home_switch,      ///< master-side: search the home switch edge, back off slowly (see axes/homing/README.md)
    set_here,         ///< the present position becomes Position, without motion
    limit_switch,     ///< master-side: to a limit switch, then slowly back: the edge where it lets go
    block,            ///< master-side: against a fixed stop
    reference_pulse,  ///< master-side: as home_switch, then slowly on to the encoder's index pulse
    absolute,         ///< the absolute encoder knows: its zero becomes Position, without motion
};

struct HomingConfig {
    HomingKind kind = HomingKind::none;
    std::int8_t method = 0;       ///< drive: 6098h
    double search_velocity = 10;  ///< u/s, to the switch; sign by method or `negative`
    double latch_velocity = 1;    ///< u/s, to the edge
    double acceleration = 100;    ///< u/s2
    double offset = 0;            ///< u: coordinate of the reference when MC_Home.Position is not given
    bool negative = true;         ///< master-side: search in negative direction
    Duration timeout = std::chrono::seconds{60};
    // block
    double torque = 0;                                    ///< fraction of rated torque that is there when the stop is reached
    double block_velocity = 1;                            ///< u/s: slower than this counts as blocked
    Duration block_time = std::chrono::milliseconds{50};  ///< torque and standstill must last so long
    CodedMarks marks{};                                   ///< of the scale, for MC_StepDistanceCoded
};

/// How the encoder behaves when power goes.
struct PositionMemory {
    bool absolute = false;       ///< it keeps its position; so does the axis its coordinates, where they are retained
    std::int64_t range = 0;      ///< counts after which it begins anew; 0 = those of the drive's position (2^32 mostly)
    double moved_while_off = 1;  ///< u: moved further than this without power, the axis must be homed again
};

struct ManualSpeeds {
    double slow = 0, fast = 0;  ///< u/s for jogging; 0 = 5 % and 25 % of the velocity limit
    double setup_velocity = 0;  ///< u/s, cap in set-up mode; 0 = slow
};

/// Where the position loop is closed.
enum class ControlMode : std::uint8_t {
    position,  ///< in the drive (CSP)
    velocity,  ///< here: the drive runs in CSV
};

/// The I part of a position loop that is closed here. It ends what a standing error the P part leaves, such as an offset of the drive.
struct PositionIntegral {
    Duration time{};       ///< in which it adds to a standing error what the P part makes of it; 0 = there is none
    double limit = 0;      ///< u/s, the most that it adds; 0 = a tenth of the velocity limit
    double dead_band = 0;  ///< u: a smaller error changes nothing of it

    static constexpr Duration least_time = std::chrono::milliseconds{1};
    [[nodiscard]] bool used() const noexcept { return time > Duration::zero(); }
};

/// What the load takes of the motor beside its inertia, in rated torques: fed forward as 60B2h.
struct LoadTorque {
    double gravity = 0;           ///< that holds the load; positive where its weight pulls to negative
    double coulomb_friction = 0;  ///< against any motion
    double viscous_friction = 0;  ///< for each u/s
    double friction_velocity =
        0;  ///< u/s: there 70 % of the Coulomb friction count, at standstill none; 0 = a hundredth of the velocity limit

    static constexpr double most = 3;  ///< rated torques: no drive gives more for long
    [[nodiscard]] bool used() const noexcept { return gravity != 0 || coulomb_friction != 0 || viscous_friction != 0; }
};

struct ControlConfig {
    ControlMode mode = ControlMode::position;
    double kv = 0;                   ///< 1/s, mode velocity: u/s for each u of following error, > 0
    double feed_forward = 1;         ///< part of the set velocity given to the drive: as its target in mode velocity, as 60B1h in position
    double torque_feed_forward = 0;  ///< part of the torque that the set acceleration needs, as 60B2h; needs rated_acceleration
    double rated_acceleration = 0;   ///< u/s2 that rated torque gives the axis, friction apart; 0 = unknown
    double output_limit = 0;         ///< u/s, of the velocity given in mode velocity; 0 = 1.2 times the velocity limit
    PositionIntegral integral{};     ///< mode velocity
    LoadTorque load{};

    /// Rated torques per u/s2; 0 = unknown.
    [[nodiscard]] double inertia() const noexcept { return rated_acceleration > 0 ? 1 / rated_acceleration : 0; }
};

/// One measured point of the screw: what to add to the set-point so that the load stands at `position`. u, machine coordinates (as
/// homed; MC_SetPosition does not move them).
struct PitchPoint {
    double position = 0, correction = 0;
};

struct CompensationConfig {
    double backlash = 0;            ///< u, >= 0: the motor's way from one flank to the other
    double velocity = 1;            ///< u/s, > 0: how fast a correction comes in
    std::vector<PitchPoint> pitch;  ///< positions rise; corrected positions too. Active once homed
};

/// Who works the holding brake.
enum class BrakeBy : std::uint8_t {
    drive,   ///< the drive by itself, or there is none
    object,  ///< the controller, through an object of the drive (60FEh)
    output,  ///< the controller, through an output of the machine
};

struct BrakeConfig {
    BrakeBy by = BrakeBy::drive;
    Duration release{};                  ///< from the word to open it until it is open: motion waits for it
    Duration engage{};                   ///< from the word to close it until it holds: power waits for it
    bool release_without_power = false;  ///< MC_SetBrake may open it while nothing else holds the load
};

/// How long an axis waits for what it needs.
struct AxisPatience {
    std::uint16_t feedback = 3;  ///< cycles without fresh feedback until the axis stops in error
    std::uint16_t feed = 3;      ///< cycles without a fed set-point that a moving axis bridges at its velocity; then it brakes
    Duration jog_lease = std::chrono::milliseconds{200};
    Duration enable = std::chrono::seconds{3};  ///< for its power stage
};

struct AxisConfig {
    std::string name;
    std::string unit = "mm";
    Gearing gearing;
    double modulo = 0;  ///< u: program positions repeat after it (360 deg); a whole or simple part of the feed; 0 = linear
    AxisLimits limits;
    AxisDefaults defaults;
    FollowingErrorWatch following;
    PositionWindows windows;
    ControlConfig control;  // it, the two above, and the limits are read in each cycle
    HomingConfig homing;
    PositionMemory memory;
    ManualSpeeds manual;
    CompensationConfig compensation;
    BrakeConfig brake;
    GantryConfig gantry;
    LoadEncoderConfig load_encoder;
    ErrorReactions reactions;      ///< to its alarms, where others are chosen than those of the alarm table
    bool require_homed = true;     ///< absolute moves need a homed axis
    bool disabled = false;         ///< left out while commissioning: its drive is never enabled
    bool encoder = false;          ///< only measures: no drive to enable, takes no motion, may be a master (limits.velocity: its fastest)
    bool simulated = false;        ///< its drive is simulated although the bus is real
    std::uint8_t queue_depth = 4;  ///< buffered commands, 1..8
    AxisPatience patience;
};

/// Alarms after which one side of a gantry stands alone: nobody holds the portal with it for long.
inline constexpr std::array one_sided_alarms{AxisAlarm::drive_fault, AxisAlarm::drive_power_lost, AxisAlarm::axis_feedback_lost,
                                             AxisAlarm::gantry_side_lost};
/// What a gantry does about them where nothing is chosen: both ramp, then both lose their power.
void choose_for_gantry(ErrorReactions& reactions) noexcept;

/// Every problem, without a bus or drive. Subjects name the field ("axes.x.limits.velocity").
[[nodiscard]] std::vector<Error> check(const AxisConfig& config);

}  // namespace taktwerk::axes
