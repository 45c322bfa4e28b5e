#pragma once
// The parts of a machine and how they hang together. Private to runtime/machine*.cpp.

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "axes/axis/axis.hpp"
#include "axes/drives/cia402/cia402_drive.hpp"
#include "axes/drives/xp200/drive_line.hpp"
#include "axes/port/drive_port.hpp"
#include "core/latest_value.hpp"
#include "core/recorder.hpp"
#include "core/spsc_ring.hpp"
#include "core/stopwatch.hpp"
#include "ecat/master.hpp"
#include "runtime/alarms.hpp"
#include "runtime/machine/alarm_log.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/positions/position_keeper.hpp"
#include "runtime/stop_levels.hpp"
#include "runtime/tasks/fault_text.hpp"
#include "runtime/tasks/io_image.hpp"
#include "runtime/tasks/object_requests.hpp"
#include "runtime/tasks/program_host.hpp"
#include "runtime/tasks/program_requests.hpp"
#include "runtime/tasks/slow_task.hpp"
#include "runtime/tasks/watched_requests.hpp"

namespace taktwerk::runtime {

struct Machine::Impl {
    Impl(MachineConfig machine, ecat::Transport& transport, const std::vector<modbus::SerialLine*>& lines, std::vector<Error>& errors);

    // machine.cpp
    void cycle(const CycleTick& tick) noexcept;
    Result<void> arm();

    // machine_serial.cpp
    void build_lines(const std::vector<modbus::SerialLine*>& serial_lines, std::vector<Error>& errors);
    axes::xp200::Xp200Drive* serial_drive(const AxisBinding& binding);
    void hold_watchdog_outputs() noexcept;
    void record_samples() noexcept;
    void watch_serial_drives() noexcept;
    /// " of line 'rs485' (/dev/ttyUSB0, 38400 baud, 8E1)"; for words, not real-time.
    [[nodiscard]] std::string line_of(std::size_t axis) const;

    // machine_tasks.cpp
    void run_tasks() noexcept;
    void run_base_task(std::size_t index) noexcept;
    void run_slow_releases() noexcept;
    void program_failed(std::size_t program, const FaultText& why) noexcept;
    void take_handshakes() noexcept;

    // machine_snapshot.cpp
    void take_variables() noexcept;
    void take_snapshot() noexcept;
    void take_trace() noexcept;
    std::vector<std::string> trace_columns() const;

    // machine_commands.cpp, machine_programs.cpp
    void take_levels(Instant now) noexcept;
    void drain_inbox(Instant now) noexcept;
    /// The newest stop of an axis that the program has declared; 0: none.
    [[nodiscard]] std::uint64_t stopped_axes_of(std::size_t program) const noexcept;
    [[nodiscard]] bool overtaken(const OperatorCommand& command) const noexcept;
    void answer(const OperatorCommand& command, Answer answer, axes::ErrorId error = axes::ErrorId::none) noexcept;
    void tell_limit(const OperatorCommand& command, CommandAnswer& reply) const noexcept;
    void execute(const OperatorCommand& command) noexcept;
    struct Verdict {
        Answer answer = Answer::accepted;
        axes::ErrorId error = axes::ErrorId::none;
    };
    [[nodiscard]] static Verdict verdict(axes::ErrorId error) noexcept;
    Verdict execute_machine(const OperatorCommand& command) noexcept;
    Verdict execute_all(const OperatorCommand& command) noexcept;
    Verdict execute_axis(const OperatorCommand& command, std::size_t axis) noexcept;
    Verdict execute_program(const OperatorCommand& command) noexcept;
    Verdict power(const OperatorCommand& command, std::size_t axis) noexcept;
    Verdict jog(const OperatorCommand& command, std::size_t axis) noexcept;
    Verdict stop(std::size_t axis) noexcept;
    void reset_machine() noexcept;
    void set_mode(Mode wanted) noexcept;
    /// `after`: OperatorCommand::after; 0 where it starts by itself.
    [[nodiscard]] bool start_program(std::size_t program, std::uint64_t after) noexcept;
    void stop_program(std::size_t program, ProgramState state) noexcept;
    void end_motion(std::size_t axis) noexcept;
    [[nodiscard]] bool start_pending(std::size_t program) const noexcept;
    /// Those that run or are about to.
    void stop_programs() noexcept;
    [[nodiscard]] bool slow_tasks_finished(std::size_t program) const noexcept;
    void renew_operator_power() noexcept;
    /// What people have set goes back to its safe value: all of it, or one client's.
    void release_outputs() noexcept;
    void release_outputs(std::uint32_t client) noexcept;
    void service_programs();

    // machine_supervision.cpp
    void supervise(Instant now, const CycleTick& tick) noexcept;
    void watch_emergency_stop() noexcept;
    void watch_restart() noexcept;
    void reset_after_emergency() noexcept;
    [[nodiscard]] bool stopped_by_emergency(std::size_t axis) const noexcept;
    /// An axis is in ErrorStop by an emergency stop that is over: whoever lets a program go on now would leave the motion to the reset.
    [[nodiscard]] bool axes_to_reset() const noexcept;
    void watch_cycle(const CycleTick& tick) noexcept;
    void blame_base_task(const CycleTick& tick) noexcept;
    void watch_programs() noexcept;
    void raise_bus_alarms() noexcept;
    [[nodiscard]] bool follows_from_another(const AlarmFact& fact) noexcept;
    void stop_axes_of_faulted_drives() noexcept;
    void raise(MachineAlarm alarm, AlarmSource source, std::uint16_t index, double a, double b) noexcept;
    void raise_fact(const AlarmFact& fact, std::span<const AlarmInfo> table) noexcept;
    void react() noexcept;
    void run_shutdown(Instant now) noexcept;
    [[nodiscard]] std::uint32_t limit(std::uint32_t strict) const noexcept {
        return config.simulation.supervision == Supervision::relaxed ? strict * 100 : strict;
    }

    struct AxisPower {
        bool held = false;  // whoever has manual control of the axis holds the power wish
        axes::CommandId jog = 0;
    };

    MachineConfig config;
    ecat::Master bus;
    IoImage io;
    MachineLayout layout;
    std::vector<std::unique_ptr<axes::DrivePort>> ports;
    std::vector<axes::cia402::Cia402Drive*> drives;  // those of `ports` that are on the bus
    struct WatchdogOutput {
        std::size_t output = 0;  // of io
        const axes::xp200::Xp200Drive* drive = nullptr;
    };
    std::vector<std::unique_ptr<axes::xp200::DriveLine>> lines;  // as config.serial; nullptr: nobody needs it
    std::vector<axes::xp200::Xp200Drive*> serial_drives;         // those of `ports` that are on a line
    std::vector<std::uint32_t> recorded_samples;                 // number of the newest one, per serial drive
    struct SerialWatch {
        std::uint16_t axis = 0;
        std::uint8_t station = 0;
        Instant online{};  // last; before that since when it is waited for
    };
    std::vector<SerialWatch> serial_watches;  // per serial drive
    std::vector<WatchdogOutput> watchdog_outputs;
    axes::MotionTables tables;
    std::vector<axes::Axis> axes;
    /// ns that this computer sent nothing right before the fault that the drive of an axis shows; 0: it was in time; -1: no fault.
    std::unique_ptr<std::atomic<std::int64_t>[]> stall_before_fault;
    /// Cycles in a row that were not answered right before it; valid as stall_before_fault is.
    std::unique_ptr<std::atomic<std::uint32_t>[]> gap_before_fault;
    void note_what_preceded_fault(std::size_t axis) noexcept;
    struct DriveEmergency {
        AlarmFact fact{};  // a is its code; 0: none
        Instant since{};
        bool told = false;      // its axis has shown the same code meanwhile
        bool raised = false;    // it has been an alarm of its own
        bool seen = false;      // in this cycle
        AlarmFact missed{};     // one that was over before anybody had told it ...
        Instant shown_until{};  // ... is an alarm until then
    };
    /// Keeps what a slave sent; true where it is no alarm of its own (yet).
    [[nodiscard]] bool told_by_an_axis(const AlarmFact& emergency) noexcept;
    /// Emergencies that came and went with nobody telling them.
    void raise_missed_emergencies() noexcept;
    void miss(DriveEmergency& last) noexcept;
    /// Notes whether an axis of that slave shows the same; false where it has none.
    bool axis_tells(DriveEmergency& last) noexcept;
    std::vector<DriveEmergency> drive_emergencies;        // per slave
    std::vector<Instant> explained_until;                 // per axis: what follows from another alarm is not listed until then
    std::vector<axes::AxisView> views;                    // where the axes keep theirs; what programs read
    std::vector<std::size_t> axis_slave;                  // index in the bus configuration; npos for virtual axes
    std::vector<std::vector<std::size_t>> shared_drives;  // the axes of each slave that carries more than one
    std::vector<AxisPower> operator_power;
    struct OutputByHand {
        bool held = false;  // a client has set it
        std::uint32_t client = 0;
    };
    std::vector<OutputByHand> outputs_by_hand;      // as io.outputs()
    WatchedRequests requests;                       // of operators; of programs through theirs
    std::vector<AxisClaims> axis_claims;            // per axis
    std::vector<ProgramRequests> program_requests;  // per program
    std::vector<std::uint64_t> start_after;         // per program: stop levels raised when its start was given; 0: it starts by itself
    bool restart_pressed = true;                    // the last level of its input: only a rising edge counts
    Instant restart_deaf_until{};                   // the press that resets may bounce, and must not be taken for the next one
    std::unique_ptr<ProgramHost> host;
    std::unique_ptr<ObjectRequests> objects;
    std::unique_ptr<PositionKeeper> positions;  // nullptr: nothing is kept
    std::vector<std::unique_ptr<SlowTask>> slow_tasks;
    std::vector<std::size_t> base_tasks, slow_task_places;  // indices into host->tasks(), task_statistics, layout.tasks
    std::vector<std::uint64_t> base_scans;                  // since start, per base task
    std::vector<ProgramState> program_states;
    std::vector<FaultText> program_faults;                    // the cycle's; handed over with stop_asked
    std::vector<TaskContext::Undeclared> program_undeclared;  // what each uses without having declared it; since its start
    std::vector<std::uint16_t> task_overruns;                 // in a row, per slow task
    std::vector<double> variable_values;                      // as this cycle shows them
    std::vector<std::uint8_t> has_base_task;                  // per program
    AlarmLog log;
    Mode mode;
    int estop_input = -1, restart_input = -1;
    std::size_t estop_slave = 0;

    SpscRing<OperatorCommand> inbox;
    SpscRing<CommandAnswer> answers;
    LatestValue<Snapshot> snapshots;
    std::unique_ptr<TraceRing> trace;
    Recorder* recorder = nullptr;

    // cycle state
    std::uint64_t cycles = 0;
    Instant now{};
    bool emergency = false;
    Instant emergency_since{}, late_until{};
    Duration late_worst{};  // while a late wake-up is shown
    std::uint32_t overruns_in_a_row = 0;
    struct LongestTask {
        std::size_t place = 0;  // in host->tasks()
        Duration run{};
    };
    LongestTask longest_base_task;  // of the last cycle
    bool late_by_a_task = false;    // this cycle comes late because a base task took too long in the last one
    LongestTask blamed;             // that task ...
    Instant blamed_until{};         // ... while that is shown
    CycleStatistics statistics;
    std::vector<TaskStatistics> task_statistics;
    StepStatistics<step_count - 1> steps;
    StopLevels levels;
    std::vector<std::uint64_t> stopped_at;  // per axis: number of the newest stop that was taken
    bool shutdown_taken = false;            // a level: it stays
    std::atomic<bool> shutdown_asked{false};
    std::atomic<std::uint64_t> pulse_cycles{0};
    std::atomic<std::int32_t> pulse_task{-1};  // of host->tasks()
    std::atomic<std::int32_t> at_hooks{-1};    // program whose start() or stop() runs
    mutable std::mutex fault_words;            // of ProgramHost::Loaded::fault: written beside the service thread
    Duration shutdown_patience{};
    std::atomic<MachinePhase> phase{MachinePhase::starting};
    Instant shutdown_since{};
    bool shutting_down = false;
    /// The outputs carry their safe values from the bus' first frames on: what enters OP must not find zeros. Service side.
    void lay_out_outputs();
    std::atomic<bool> outputs_laid_out{false};  // the cycle may write them although nothing runs yet
    std::atomic<bool> armed{false};             // arm() runs on the service side while cycles already run

    /// start() and stop() of a program run on the service side: the cycle asks, the service answers. While the handshake is not
    /// `none` no task of the program runs, nothing reads its variables, and start() and stop() never run beside its tasks.
    ///   cycle    none -> start_asked    any -> stop_asked    started, failed -> none
    ///   service  start_asked -> started or failed    stop_asked -> none or failed, once its slower tasks have ended
    enum class Handshake : std::uint8_t { none, start_asked, started, stop_asked, failed };
    std::unique_ptr<std::atomic<Handshake>[]> handshakes;
};

}  // namespace taktwerk::runtime
