#pragma once
// One machine as plain data: what config/ fills from YAML and tests fill by hand. Everything is checked before anything runs.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "axes/axis/axis_config.hpp"
#include "axes/group/group_config.hpp"
#include "axes/port/drive_profile.hpp"
#include "axes/port/encoder_channel.hpp"
#include "axes/sim/plant_config.hpp"
#include "axes/tables/cam_table.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/bus_config.hpp"
#include "fb_library/gcode/interpreter_options.hpp"
#include "modbus/tcp/device_config.hpp"
#include "programs/api/program_entry.hpp"
#include "runtime/analog_axis.hpp"
#include "runtime/io_point.hpp"
#include "runtime/recording_config.hpp"
#include "runtime/retain_config.hpp"
#include "runtime/serial_config.hpp"

namespace taktwerk::runtime {

/// When the outputs of a cycle leave (docs/architecture.md).
enum class SendMode : std::uint8_t {
    after_plan,  ///< as soon as they are computed
    at_tick,     ///< at the start of the next cycle: constant send time, one cycle more dead time
};

/// What a sensor sees that is wired to probe 1 of the simulated drive. u, machine coordinates.
struct PrintedMarks {
    double first = 0, every = 0, length = 0;  ///< every = 0: none
};

/// Simulation of one axis' mechanics, in the axis' own unit; used with --simulate or `simulated: true`.
struct AxisSimulation {
    double inertia = 2e-4, viscous_friction = 1e-3, coulomb_friction = 0.05, load_torque = 0;  ///< SI at the motor shaft
    double rated_torque = 1.27;                                                                ///< N m
    double breakaway_torque = 0;       ///< N m: friction at standstill; 0 = as Coulomb
    axes::sim::ElasticLoad elastic{};  ///< a load behind a shaft that twists
    axes::sim::Cogging cogging{};
    axes::sim::ServoGains gains{};                         ///< of the drive's loops
    double start = 0;                                      ///< u: where the axis stands at power-on
    double racked = 0;                                     ///< u: how far the follower of a gantry is ahead of its leader then
    std::optional<double> negative_stop, positive_stop;    ///< u: hard stops
    std::optional<double> negative_limit, positive_limit;  ///< u: limit switches
    std::optional<double> home_from, home_to;              ///< u: home switch active in between
    double index_pulse = 0;  ///< u: where one of the encoder's index pulses stands; there is one each motor turn
    axes::sim::Battery battery = axes::sim::Battery::good;  ///< of an absolute encoder
    PrintedMarks marks;
    double clock_drift_ppm = 0;
    // Of an encoder at a terminal (AxisBinding::encoder): what turns it.
    std::string turned_by;  ///< axis whose motor does, u for u; empty: it turns by itself
    double velocity = 0;    ///< u/s, by itself
    AnalogSimulation analog;
};

/// The other side of a portal on two drives (AxisConfig::gantry). Its counts are those of the axis' gearing.
struct GantryFollower {
    std::string slave;            ///< name in BusConfig
    std::uint8_t drive_axis = 0;  ///< 0-based
    bool mirrored = false;        ///< mounted the other way round
    std::shared_ptr<const axes::DriveProfile> profile;
    std::vector<axes::StoredSetting> stored;
};

struct AxisBinding {
    axes::AxisConfig axis;
    std::string slave;            ///< name in BusConfig; empty: a purely virtual axis
    std::string drive;            ///< name of a drive on a serial line, instead of a slave
    std::uint8_t drive_axis = 0;  ///< 0-based axis of a multi-axis drive
    std::shared_ptr<const axes::DriveProfile> profile;
    std::optional<axes::EncoderChannel> encoder;  ///< what counts, where no drive does: the axis only measures, or is `analog`
    std::optional<AnalogAxis> analog;             ///< its motor, at an amplifier over +-10 V; `encoder` is the motor's
    std::string load_input;                       ///< input point that counts at the load (AxisConfig::load_encoder)
    std::string brake_output;                     ///< output point that opens its holding brake (BrakeBy::output)
    std::vector<axes::StoredSetting> stored;      ///< in the drive's EEPROM once it was commissioned
    AxisSimulation simulation;
    GantryFollower follower;
};

/// Each drive on the bus as a binding of its own: those of the axes, then the followers of gantries as "<axis>.follower".
[[nodiscard]] std::vector<AxisBinding> sides_of(const std::vector<AxisBinding>& axes);

/// What happens when a slower task has missed more releases in a row than it may.
enum class OverrunReaction : std::uint8_t { count, stop_program, stop_machine };

struct TaskConfig {
    std::string name;           ///< task as the program declares it
    std::string program;        ///< program name
    std::uint16_t divisor = 1;  ///< 1 = base task, inline in the cycle
    OverrunReaction overrun = OverrunReaction::stop_program;
    std::uint16_t overruns_allowed = 3;  ///< in a row
    /// How long a run of a slower task may take, from its release on; its program is stopped then. Nothing: as TaskWatch has it; 0: no limit while its program runs.
    std::optional<Duration> watchdog{};
    std::uint16_t watchdog_sensitivity = 1;  ///< so many runs in a row, or one that takes so many times as long
    std::optional<int> priority{};           ///< SCHED_FIFO, of a slower task's thread; 0: an ordinary thread. Nothing: by its period
};

/// A parameter as the machine file sets it. Which unit it has only its program knows: a value with a unit comes in every unit that it
/// can be told in.
struct ParameterValue {
    struct InUnit {
        std::string unit;
        double value = 0;
    };
    std::string name;
    double value = 0;                ///< written without a unit: in that of the program
    std::string text{};              ///< written with one: "60 mm" ...
    std::vector<InUnit> in_units{};  ///< ... and what that is: 60 mm, 6 cm, 0.06 m
};

struct ProgramConfig {
    std::string name;
    std::string library;                       ///< path of the shared object; empty: `entry`
    const ProgramEntry* (*entry)() = nullptr;  ///< linked in (tests)
    std::vector<ParameterValue> parameters;
    bool autostart = false;  ///< starts when the machine is up, in automatic mode
};

/// A cam of the machine file: every program that asks for it gets a table of its own.
struct CamConfig {
    std::string name;
    std::string master{}, slave{};  ///< axes in whose units the points are
    bool periodic = false;          ///< meant to be repeated; said to MC_CamTableSelect by the program
    std::vector<axes::CamPoint> points{};
};

enum class Mode : std::uint8_t { manual, setup, automatic };

struct EmergencyStop {
    std::string input;  ///< name of an input point that is TRUE while all is well (normally closed); empty: none
    Duration power_off_after = std::chrono::milliseconds{500};  ///< power goes off when the axes stand, at the latest then
    /// Input of a button. Its rising edge after the release resets the axes that the emergency stop holds in ErrorStop; where none is left it
    /// lets the programs power their axes again, as program_start does. Empty: none.
    std::string restart;
};

/// When the base cycle itself comes too late.
struct CycleWatch {
    std::uint16_t overruns_allowed = 10;  ///< missed ticks in a row until the machine stops
    Duration lateness_warning{};          ///< 0 = a quarter of the cycle
};

struct RealtimeConfig {
    int priority = 80;      ///< SCHED_FIFO; 0 = leave
    std::vector<int> cpus;  ///< empty = leave
    bool lock_memory = true;
    bool required = false;  ///< refuse to start when the system does not grant it
};

enum class Supervision : std::uint8_t {
    strict,   ///< every missed exchange counts against the limits
    relaxed,  ///< network and host without real time: misses are counted, limits are 100 times wider
};

/// Something that happens to the simulated machine at a given machine time: for demos, rehearsals and tests.
struct SimulationEvent {
    enum class Kind : std::uint8_t { input, input_fault, drive_fault, main_power, slave_power, jam, serial_line, group };
    Duration at{};  ///< since start of the run
    Kind kind = Kind::input;
    std::string
        target;  ///< input point (input, input_fault), axis (drive_fault, main_power, jam), slave (slave_power), line (serial_line),
                 ///< group (group)
    std::int64_t value =
        0;  ///< input value, raw; 1 = the terminal reports an error of it; 603Fh code; 1 = power on / free / plugged / connected, 0 = power off / jammed / cut
};

/// Where a simulated slave hangs, and how good its clock is. Without one a slave hangs behind port 1 of the slave before it.
struct SlaveSimulation {
    std::string slave;
    std::string behind;                    ///< slave towards the master; empty: the one before it
    std::uint8_t port = 1;                 ///< 1..3: that slave's socket. A frame takes 3 before 1 before 2
    double cable = 10;                     ///< metres
    std::optional<double> drift_ppm = {};  ///< of its clock; instead of the axis' clock_drift
};

/// How a simulated group of hot connect is coupled. Without one: by hand, and connected at the start.
struct GroupSimulation {
    std::string group;
    bool connected = true;      ///< at the start
    std::string released_by;    ///< output point: lets go when it rises, takes it again when it falls; empty: by hand
    std::string axis;           ///< that carries the coupling; empty: it couples wherever it is
    double at = 0, within = 1;  ///< u of that axis: where the group lies, and how near counts
};

struct SimulationConfig {
    Supervision supervision = Supervision::strict;
    std::vector<SlaveSimulation> slaves;
    std::vector<GroupSimulation> groups;
    std::vector<SimulationEvent> events;
};

/// What was on the bus around each alarm that stops something, for Wireshark.
struct EvidenceConfig {
    std::string directory;         ///< empty: none is kept
    std::uint16_t files = 20;      ///< so many are kept, the newest; 0: all
    std::uint16_t megabytes = 16;  ///< of memory for the last frames, taken twice
};

/// A program in G-code for the groups: MC_PathSelect. Its text is configuration: read when the machine starts, known to a recording by its check sum.
struct PathConfig {
    std::string name, file;
    std::shared_ptr<const std::string> text{};
    gcode::InterpreterOptions options{};  ///< tools, offsets, reference positions, units
};

struct MachineConfig {
    std::string name = "machine";
    Duration cycle = std::chrono::milliseconds{1};
    SendMode send = SendMode::after_plan;
    Mode start_mode = Mode::manual;
    ecat::BusConfig bus;
    std::vector<SerialLineConfig> serial;
    std::vector<modbus::tcp::DeviceConfig> modbus;  ///< their points have `beside`
    std::vector<AxisBinding> axes;
    std::vector<axes::AxisGroupConfig> axis_groups{};  ///< of axes that move together, for programs
    std::vector<PathConfig> paths{};                   ///< programs in G-code that groups go
    std::vector<IoPoint> io;
    std::vector<TaskConfig> tasks;
    std::vector<CamConfig> cams;
    std::vector<ProgramConfig> programs;
    EmergencyStop emergency_stop;
    CycleWatch watch;
    RealtimeConfig realtime;
    SimulationConfig simulation;
    RetainConfig retain;
    EvidenceConfig evidence;
    RecordingConfig recording;
    bool fell_back = false;               ///< it runs from a bundle, and not from the version that was to run
    std::uint8_t commands_per_cycle = 4;  ///< K operator commands drained per cycle
};

/// What relaxed supervision gives slaves without a watchdog of their own: a stall of the host must not trip them.
inline constexpr Duration relaxed_watchdog = std::chrono::milliseconds{500};

/// The SM watchdog that a slave of this machine gets.
[[nodiscard]] inline Duration sm_watchdog(const MachineConfig& machine, const ecat::SlaveConfig& slave) {
    const bool relaxed = machine.simulation.supervision == Supervision::relaxed && slave.sm_watchdog == Duration{};
    return relaxed ? relaxed_watchdog : ecat::sm_watchdog(machine.bus, slave);
}

}  // namespace taktwerk::runtime
