#pragma once
// One machine and its cycle (docs/architecture.md). Built from plain structs; knows no YAML and no LCM.
//
//   build -> start_bus() -> cycle(...) each period and service(now) beside it, from another thread or between cycles; once
//   bus_operational(): arm(). In virtual time one thread calls them in a fixed order (runtime/run/virtual_runner.hpp).

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "axes/excitation/measure_sample.hpp"
#include "axes/port/drive_port.hpp"
#include "core/recorder.hpp"
#include "core/result.hpp"
#include "core/stopwatch.hpp"
#include "core/time.hpp"
#include "ecat/transport/transport.hpp"
#include "modbus/line/serial_line.hpp"
#include "modbus/tcp/exchange.hpp"
#include "runtime/cycle_histograms.hpp"
#include "runtime/cycle_tick.hpp"
#include "runtime/machine_config.hpp"
#include "runtime/operator_command.hpp"
#include "runtime/recording/signal_ring.hpp"
#include "runtime/retain/retain_note.hpp"
#include "runtime/snapshot.hpp"
#include "runtime/stop_levels.hpp"

namespace taktwerk::runtime {

/// An alarm in words, for people. Made outside the cycle.
struct AlarmText {
    std::string source;  ///< "axis x", "slave 2 'y_drive'", "machine"
    std::string name, english, chinese, cause, remedy;
    std::string reaction, reset;
    std::string manual{};  ///< of a drive's own alarm: its profile and the section of its manual, "sv33-e 5.4"
};

class BusLook;
class ReplayedInbox;
struct FaultsSeen;

/// Who calls a recorded machine: one thread for everything (virtual time), or the cycle's thread for cycles, service_bus(), arm(), start_bus() and
/// stop_bus(), and any others for the rest (RealtimeRunner::record_in_step()).
enum class RecordedThreads : std::uint8_t { several, one };

class Machine {
public:
    /// Checks everything, loads the programs, takes all memory. `transport` outlives the machine. All problems at once.
    /// `lines`: one for each of `config.serial`, in its order; they outlive the machine too and are used on the service side only. nullptr:
    /// none, which is an error (serial.no_line) unless every axis on it is simulated.
    /// `exchanges`: one for each of `config.modbus`, likewise; each is used on the thread of service_modbus().
    static std::variant<std::unique_ptr<Machine>, std::vector<Error>> build(MachineConfig config, ecat::Transport& transport,
                                                                            std::vector<modbus::SerialLine*> lines = {},
                                                                            std::vector<modbus::tcp::Exchange*> exchanges = {});
    ~Machine();
    Machine(const Machine&) = delete;
    Machine& operator=(const Machine&) = delete;

    // --- service side (one thread, not real-time) -----------------------------------------------------------------------
    void start_bus();
    /// Takes the bus down in order. After phase() is `stopped`; service() and cycle() go on until the bus says stopped.
    void stop_bus();
    /// Bus scripts, drive services, slow work. Call often (each millisecond or after each virtual cycle). Its parts that follow
    /// one after the other, for one thread; in real time each has a thread of its own, so that what may wait holds up nobody else.
    void service(Instant now);
    /// Nothing in it waits: bus scripts, serial lines, services of the drives.
    void service_bus(Instant now);
    /// The planners of groups of axes: tens of milliseconds where a path is long. Where the run is recorded service_bus() does it, in its order.
    void service_groups();
    [[nodiscard]] std::size_t group_count() const noexcept;
    /// start() and stop() of programs: foreign code, it may take any time.
    void service_programs();
    /// What is kept onto the disk: it waits until it is there.
    void service_disk(Instant now);
    /// Modbus TCP devices: one thread for each. A step takes the device's `timeout` at most; end_modbus() likewise: when the cycle has
    /// ended it writes outputs that changed, until it says false.
    [[nodiscard]] std::size_t modbus_count() const noexcept;
    void service_modbus(std::size_t device, Instant now);
    [[nodiscard]] bool end_modbus(std::size_t device, Instant now);
    /// After the bus is operational: signals resolved, image layout known. Once. Then cycle() may run programs.
    [[nodiscard]] Result<void> arm();
    [[nodiscard]] bool bus_operational() const noexcept;
    [[nodiscard]] std::optional<Error> bus_failure() const;
    [[nodiscard]] std::string bus_progress() const;

    // --- cycle (one thread, real-time safe after arm()) ------------------------------------------------------------------
    void cycle(const CycleTick& tick) noexcept;
    /// Before arm(): acyclic frames only.
    void pump(Instant now) noexcept;
    /// Runs the slower tasks that were released: called after each cycle in virtual time.
    void run_slow_tasks() noexcept;
    /// The slower tasks, for threads of their own in real time: task `index` runs if it was released. True when it did.
    [[nodiscard]] std::size_t slow_task_count() const noexcept;
    bool run_slow_task(std::size_t index) noexcept;
    /// Behind a run, on its thread: the scan time of the cycle that had released it.
    [[nodiscard]] Instant slow_task_released(std::size_t index) const noexcept;
    [[nodiscard]] const TaskConfig& slow_task(std::size_t index) const noexcept;
    /// Before the first cycle, in real time: tasks that ask are told how long they took. Else that is 0.
    void tell_measured_times() noexcept;

    // --- between the two ---------------------------------------------------------------------------------------------------
    /// Service side: queue a command for the next cycle. False: inbox full (answer queue_full).
    bool submit(const OperatorCommand& command) noexcept;
    /// Service side: the next answer of the cycle, if any.
    std::optional<CommandAnswer> next_answer() noexcept;
    /// Service side (one reader): the newest snapshot; nullptr before the first cycle.
    const Snapshot* latest() noexcept;
    /// Service side (one reader): the samples of a measurement (OperatorAction::measure), oldest first. False: none is there.
    bool next_measure_sample(axes::MeasureSample& out) noexcept;
    /// Levels, not queued: any thread and signal handlers. Real-time safe, async-signal-safe; they act in the next cycle, and cannot be
    /// refused. Stop: along the ramp, whoever owns the axis; `axis` 0xFFFF means all.
    StopLevels::Ticket request_stop(std::uint16_t axis) noexcept;
    /// A jog was let go, or its client is lost: whatever moves the axis by hand stops. A program's axis goes on: a press there was refused.
    StopLevels::Ticket release_jog(std::uint16_t axis) noexcept;
    /// Before arm() the next cycle says `stopped`.
    StopLevels::Ticket request_shutdown() noexcept;
    /// The cycle has taken that level. Any thread.
    [[nodiscard]] bool taken(StopLevels::Ticket ticket) const noexcept;
    /// For OperatorCommand::after. Any thread.
    [[nodiscard]] std::uint64_t levels_raised() const noexcept;
    [[nodiscard]] bool shutdown_asked() const noexcept;
    /// From a shutdown on, with a margin for a drive that does not answer: then phase() is `stopped`, if the cycle advances.
    [[nodiscard]] Duration longest_stop() const noexcept;
    /// What the cycle is at, for who looks from outside whether it advances (advance_watch.hpp). Any thread.
    struct Pulse {
        std::uint64_t cycles = 0;  ///< ended so far, those before arm() too
        std::int32_t task = -1;    ///< base task that runs now; -1: none
    };
    [[nodiscard]] Pulse pulse() const noexcept;
    struct TaskNames {
        std::string program, task;
    };
    [[nodiscard]] TaskNames task_names(std::size_t task) const;
    /// "task 'plan' of program 'cell'", or "start() of ...": code of a program that runs beside the cycle and has not returned; empty: none.
    /// Any thread.
    [[nodiscard]] std::string program_at_work() const;
    /// What became of the kept values of programs and parameters at the start. Any thread.
    [[nodiscard]] std::span<const RetainNote> retain_notes() const noexcept;
    /// What is kept is being written: one call of the disk that has not come back yet. Any thread.
    [[nodiscard]] bool disk_at_work() const noexcept;
    [[nodiscard]] MachinePhase phase() const noexcept;
    /// Every signal of every cycle since arm(), the newest of them: for any number of readers, each on any thread (signal_ring.hpp). Its
    /// cycles count as Snapshot::cycle.
    [[nodiscard]] SignalRing& signals() noexcept;
    [[nodiscard]] const SignalRing& signals() const noexcept;
    /// Before start_bus(): everything that comes from outside goes into `recorder` (runtime/recording/inbox_record.hpp says how), and what each
    /// cycle makes of it (outcome_record.hpp), written by the cycle thread. `recorder` outlives the machine. Off unless called.
    void record(Recorder& recorder, RecordedThreads threads = RecordedThreads::several);
    /// For who replays a recording (runtime/replay/): where it goes in again.
    [[nodiscard]] ReplayedInbox& replayed() noexcept;
    /// Times per step (Step order), for benchmarks and the monitor. Read by the cycle thread, or when it stands.
    [[nodiscard]] const StepStatistics<step_count - 1>& step_statistics() const noexcept;
    void reset_step_statistics() noexcept;
    /// Any thread.
    [[nodiscard]] MachineTimes times() const noexcept;

    [[nodiscard]] const MachineConfig& config() const noexcept;
    [[nodiscard]] const MachineLayout& layout() const noexcept;
    /// Service side.
    [[nodiscard]] AlarmText describe(const AlarmFact& fact) const;
    /// Service side: parameters and services of an axis' drive, beside the cycle: read_parameter(), write_parameter(), start_service(),
    /// service_answer() and capabilities() alone are for callers from outside. nullptr: no such axis, or a virtual one.
    [[nodiscard]] axes::DrivePort* drive_port(std::size_t axis) noexcept;
    /// One thread beside the cycle: page faults of the cycle's thread since the machine operates (runtime/run/fault_watch.hpp).
    void tell_page_faults(const FaultsSeen& seen) noexcept;
    /// Service side: how the slaves' ports stand, for whoever asks.
    [[nodiscard]] BusLook& bus_look() noexcept;
    /// Service side: what a program threw when it stopped by itself; empty when it did not.
    [[nodiscard]] std::string program_fault(std::size_t program) const;
    [[nodiscard]] const ecat::Master& bus() const noexcept;
    [[nodiscard]] ecat::Master& bus() noexcept;

private:
    struct Impl;
    explicit Machine(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace taktwerk::runtime
