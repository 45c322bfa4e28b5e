#pragma once
// The one copy of the machine's state that leaves the cycle: HMI, command line, trace, recorder all read this. Buffers are
// sized when the machine is built; copying allocates nothing.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "axes/axis/axis_view.hpp"
#include "core/alarm.hpp"
#include "core/time.hpp"
#include "ecat/master.hpp"
#include "programs/api/program.hpp"
#include "runtime/command_events.hpp"
#include "runtime/forced_point.hpp"
#include "runtime/machine_config.hpp"
#include "runtime/measure_state.hpp"
#include "runtime/passed_alarms.hpp"
#include "runtime/seen_group.hpp"

namespace taktwerk::runtime {

enum class MachinePhase : std::uint8_t { starting, running, stopping, stopped, failed };
enum class ProgramState : std::uint8_t { stopped, running, fault };

/// An alarm that is standing or waits for acknowledgement.
struct ActiveAlarm {
    AlarmFact fact;
    Instant since{};
    std::uint32_t count = 0;  ///< times raised since it was last clear
    bool standing = false;    ///< the condition still holds
    bool acknowledged = false;
    Reaction reaction = Reaction::none;
};

/// Steps of a cycle (docs/architecture.md), for statistics.
enum class Step : std::uint8_t { receive, inbox, decode, update, supervise, tasks, plan, encode, send, snapshot, total };
inline constexpr std::size_t step_count = 11;
[[nodiscard]] std::string_view name(Step step) noexcept;

struct CycleStatistics {
    std::uint64_t cycles = 0, overruns = 0, missed_ticks = 0;
    Duration lateness{}, lateness_max{};  ///< of the wake-up
    Duration compute{}, compute_max{};    ///< steps 1 to 10
    std::uint64_t snapshots_dropped = 0;  ///< rows that a trace came too late for
    std::uint64_t commands_refused = 0;
    std::uint64_t page_faults = 0;       ///< of the cycle's thread, from a second after the machine runs on; virtual time has none
    std::uint64_t disk_page_faults = 0;  ///< those of them that waited for a disk
};

struct TaskStatistics {
    std::uint64_t releases = 0, overruns = 0;
    Duration run{}, run_min{}, run_max{};
    Duration lateness{}, lateness_max{};  ///< from the release to the first instruction; of a base task: of its cycle
    std::uint64_t booked = 0;             ///< since the measured ones were begun anew ...
    Duration run_total{};                 ///< ... and their sum
    [[nodiscard]] Duration run_mean() const noexcept { return booked == 0 ? Duration{} : run_total / static_cast<Duration::rep>(booked); }
    void book(Duration took, Duration late) noexcept {
        run = took;
        run_min = booked == 0 ? took : std::min(run_min, took);
        run_max = std::max(run_max, took);
        lateness = late;
        lateness_max = std::max(lateness_max, late);
        run_total += took;
        ++booked;
        ++releases;
    }
    void begin_anew() noexcept {
        run_min = run_max = lateness_max = run_total = {};
        booked = 0;
    }
};

/// Of an axis' following error over all cycles since the start, or since people have begun anew. u; both 0: none so far.
struct FollowingPeak {
    double minimum = 0, maximum = 0;
};

struct Snapshot {
    std::uint64_t cycle = 0;
    Instant at{};  ///< scan time of that cycle
    MachinePhase phase = MachinePhase::starting;
    Mode mode = Mode::manual;
    bool emergency_stop = false;  ///< pressed (or its wire is broken)
    bool simulated = false;
    ecat::Master::Phase bus_phase = ecat::Master::Phase::idle;
    ecat::BusStatistics bus;
    CycleStatistics statistics;
    std::vector<ecat::SlaveHealth> slaves;
    std::vector<axes::AxisView> axes;
    std::vector<FollowingPeak> following_peaks;  ///< one per axis
    std::vector<SeenGroup> groups;               ///< of axes, in the order of the configuration
    std::vector<std::int64_t> inputs, outputs;   ///< one per I/O point, in configuration order of that direction: raw words
    std::vector<PointValue> input_values;        ///< the same in their units
    std::vector<double> output_values;
    std::array<ForcedPoint, max_forces> forces{};  ///< the first force_count are valid, oldest first
    std::size_t force_count = 0;
    std::vector<double> parameters;
    std::vector<double> variables;  ///< monitored variables of all programs
    std::vector<ProgramState> programs;
    std::vector<TaskStatistics> tasks;
    std::vector<ActiveAlarm> alarms;  ///< capacity fixed; the first alarm_count are valid, newest last
    std::size_t alarm_count = 0;
    PassedAlarms passed_alarms;
    std::array<CommandEvent, CommandEvents::capacity> events{};  ///< the first event_count are valid, newest last
    std::size_t event_count = 0;
    std::uint64_t event_revision = 0, events_dropped = 0;
    MeasureState measure;
};

/// Names and units that go with a snapshot; fixed when the machine is built.
struct MachineLayout {
    struct Variable {
        std::string program, name, unit, doc;
        VariableType type = VariableType::real;
        bool writable = false;            ///< by people (Declaration::operator_value) ...
        bool momentary = false;           ///< ... a button: TRUE while it is held
        double minimum = 0, maximum = 0;  ///< of a writable one
        [[nodiscard]] bool whole() const noexcept { return type != VariableType::real && type != VariableType::duration; }
        [[nodiscard]] bool takes(double number) const noexcept {  // also not NaN
            return writable && number >= minimum && number <= maximum && (!whole() || number == std::floor(number));
        }
    };
    struct ParameterInfo {
        std::string program, name, unit, doc;
        double minimum = 0, maximum = 0, value = 0;
        bool whole = false;                                       ///< no other numbers than whole ones
        [[nodiscard]] bool takes(double number) const noexcept {  // also not NaN
            return number >= minimum && number <= maximum && (!whole || number == std::floor(number));
        }
    };
    struct AxisInfo {
        std::string name, unit;
        bool disabled = false, simulated = false;
        double jog_slow = 0, jog_fast = 0;    ///< u/s
        std::string drive, profile;           ///< slave, or drive on a serial line, and its kind; empty: a virtual axis
        int drive_axis = 0;                   ///< of that drive, from 0
        std::string group{};                  ///< of hot connect, that the drive is in; empty: always there
        std::vector<std::string> programs{};  ///< those that declare it: only one of them may command it
        // As configured: u, u/s, u/s2, u/s3; infinity = none. What holds now is in the axis' parameters.
        double position_min = -std::numeric_limits<double>::infinity(), position_max = std::numeric_limits<double>::infinity();
        double velocity_limit = 0, acceleration_limit = 0, deceleration = 0;
        double jerk_limit = std::numeric_limits<double>::infinity();
        double following_window = std::numeric_limits<double>::infinity();
        double in_position_window = 0;
        double modulo = 0;  ///< 0 = a linear axis
        axes::HomingKind homing = axes::HomingKind::none;
    };
    /// Axes that move together.
    struct GroupInfo {
        std::string name, unit;              ///< unit: of the tool's place, of paths
        std::vector<std::uint16_t> members;  ///< axes as configured, by place; a program may change them
        bool arm = false;                    ///< has kinematics: its tool has a place in the machine
        std::array<bool, 6> commands{};      ///< which of X Y Z RX RY RZ the arm commands
        double setup_velocity = 0;           ///< u/s: of the tool's point in set-up mode at most, and of a person's jog of it; 0: no arm
        struct Room {
            std::string name;
            bool kept_free = false;
        };
        std::vector<Room> rooms{};  ///< of its workspace; their places are those of PathHindrance::room
    };
    struct Block {
        std::string name;  ///< program.block
        const std::byte* begin = nullptr;
        std::size_t size = 0;
    };
    /// The declared block that `instance` is or lies in (AxisView::holder); empty = none, or one that its program gave no name.
    [[nodiscard]] std::string_view block_at(const void* instance) const noexcept;

    std::string machine;
    std::string interface;                    ///< of the bus; empty: simulated
    std::vector<std::string> serial_devices;  ///< of the serial lines that are not simulated
    Duration cycle{};
    std::vector<AxisInfo> axes;
    std::vector<GroupInfo> groups;
    std::vector<Block> blocks;
    std::vector<std::string> slaves, inputs, outputs, programs, tasks;
    std::vector<std::string> input_units, output_units;  ///< one per point; empty: the number itself
    std::vector<std::string> kept_inputs, kept_outputs;  ///< one per point: why nobody may force it; empty: may be forced
    std::vector<Variable> variables;
    std::vector<ParameterInfo> parameters;
};

}  // namespace taktwerk::runtime
