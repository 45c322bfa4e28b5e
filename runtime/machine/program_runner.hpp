#pragma once
// The programs of a machine while it runs: how they start and stop, step 6 with their tasks, and what ends with a program: its axes, its
// outputs. The cycle asks for start() and stop(), the service side calls them (Handshake, program_record.hpp).

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/machine/hand_motion.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/operator_values.hpp"
#include "runtime/machine/retained_image.hpp"
#include "runtime/machine/task_times.hpp"
#include "runtime/tasks/object_requests.hpp"
#include "runtime/tasks/program_host.hpp"
#include "runtime/tasks/program_record.hpp"
#include "runtime/tasks/slow_task.hpp"
#include "runtime/tasks/task_watch.hpp"

namespace taktwerk::runtime {

class ProgramRunner {
public:
    /// Loads the programs, lets them declare, makes their tasks ready. The axes are there.
    ProgramRunner(MachineBody& body, HandMotion& hands, std::vector<Error>& errors);

    // --- cycle: real-time safe ---------------------------------------------------------------------------------------------------
    /// What came from beside the cycle: start() and stop() that have ended, slower tasks, answers of drives to the programs' object requests.
    void take_answers() noexcept;
    /// Step 6: base tasks run here, inline; slower ones are applied and released.
    void run_tasks(std::uint32_t missed_ticks) noexcept;
    /// Alarms that programs raise, and those about them.
    void raise_alarms() noexcept;
    /// Commands of groups that are over. Behind their plans.
    void look_at_groups() noexcept { groups_.end_of_cycle(body_.emergency || body_.shutting_down, programs_); }
    /// What the variables are at the end of this cycle.
    void read_variables() noexcept;
    /// The same of what is kept over a time without power. Of a program whose start() or stop() is at work, or which is no slow task's turn, it
    /// stays what it was.
    void read_retained() noexcept;
    [[nodiscard]] RetainedImage& retained() noexcept { return retained_; }

    /// `after`: OperatorCommand::after; 0 where it starts by itself. False: its stop() is still to come.
    [[nodiscard]] bool start(std::size_t program, std::uint64_t after) noexcept;
    void stop(std::size_t program, ProgramState state) noexcept;
    /// Those that run or are about to.
    void stop_all() noexcept;
    /// What stopped by a fault may start again, and overruns count anew: the alarms of both go, but for that of a task that is still at work.
    void reset() noexcept;
    /// The same of one program, whose tasks' overruns go on counting.
    void reset(std::size_t program) noexcept;
    /// An alarm of the program's own that stops its axes: those that it powers or moves.
    void stop_axes_of(std::size_t program, AlarmId reason) noexcept;
    [[nodiscard]] bool any_runs_or_starts() const noexcept;
    /// As OperatorAction::set_value.
    Verdict write_value(const OperatorCommand& command) noexcept;
    /// A stop of this axis (StopLevels::all_axes: of all): buttons of programs that use it are let go, and want a new press.
    void let_go_for_stop(std::uint16_t axis) noexcept;
    [[nodiscard]] OperatorValues& values() noexcept { return values_; }
    /// The newest stop of an axis that the program has declared; 0: none.
    [[nodiscard]] std::uint64_t newest_stop_of(std::size_t program) const noexcept;

    [[nodiscard]] ProgramRecords& programs() noexcept { return programs_; }
    [[nodiscard]] const ProgramRecords& programs() const noexcept { return programs_; }
    [[nodiscard]] std::vector<double>& parameters() noexcept { return host_.parameters(); }
    [[nodiscard]] const std::vector<double>& variables() const noexcept { return variable_values_; }
    [[nodiscard]] TaskTimes& times() noexcept { return times_; }
    [[nodiscard]] const TaskTimes& times() const noexcept { return times_; }
    struct LongestTask {
        std::size_t place = 0;  ///< in the layout's tasks
        Duration run{};
    };
    /// Of the last cycle.
    [[nodiscard]] const LongestTask& longest_base_task() const noexcept { return longest_base_task_; }

    /// Before the first scan: what was kept stands in the variables, and these items are blocks that go on. Not real-time.
    void restored(std::span<const std::size_t> warm_blocks);

    // --- other threads -----------------------------------------------------------------------------------------------------------
    /// start() and stop() that were asked for.
    void call_hooks();
    /// For a replay: that one has run. False: there is no such program.
    [[nodiscard]] bool replay_hook(std::size_t program, bool stop);
    /// For a replay: what the task is told in its next scan. False: there is no such task.
    [[nodiscard]] bool replay_times(const TaskTimesRecord& record) noexcept;
    /// Object requests on their way to the drives. Service side.
    void carry_requests() { objects_.step(body_.bus); }
    [[nodiscard]] std::size_t slow_task_count() const noexcept { return slow_tasks_.size(); }
    bool run_slow_task(std::size_t index) noexcept { return slow_tasks_[index].task->run_if_released(); }
    [[nodiscard]] const SlowTask& slow_task(std::size_t index) const noexcept { return *slow_tasks_[index].task; }
    /// The bus has laid out its image. Before the first cycle with tasks.
    void learn_outputs() noexcept;
    /// As Machine has them.
    [[nodiscard]] std::string at_work() const;
    [[nodiscard]] std::string fault(std::size_t program) const;
    [[nodiscard]] std::int32_t base_task_at_work() const noexcept { return pulse_task_.load(std::memory_order_relaxed); }

    [[nodiscard]] ProgramHost& host() noexcept { return host_; }
    [[nodiscard]] const ProgramHost& host() const noexcept { return host_; }

private:
    struct BaseTask {
        std::size_t place = 0;                    // in host_.tasks(), times_, the layout
        std::uint64_t scans = 0;                  // since its program's start
        std::vector<SlowTask::WarmBlock> warm{};  // before its first scan
    };
    struct SlowPlace {
        std::unique_ptr<SlowTask> task;
        std::size_t place = 0;
        TaskWatch watch;
        bool finished = true;            // as the cycle knows it
        double taken = 0;                // of what its alarm tells: overruns in a row, or milliseconds
        std::vector<std::size_t> shows;  // the variables that are read after its runs
        std::vector<std::size_t> keeps;  // what is kept of its memory: places in host_.retained()
    };

    // program_runner.cpp
    void build_tasks();
    [[nodiscard]] std::vector<std::size_t> variables_of(std::size_t task) const;
    [[nodiscard]] std::vector<std::size_t> kept_of(std::size_t task) const;
    [[nodiscard]] std::size_t keeper_of(const RetainedItem& item) const noexcept;
    void take_handshakes() noexcept;
    void failed(std::size_t program, const FaultText& why) noexcept;
    void end_motion(std::size_t axis) noexcept;
    void let_go_of_groups(std::size_t program) noexcept;
    void release_outputs_of(std::size_t program, bool others_run) noexcept;
    [[nodiscard]] bool slow_tasks_finished(std::size_t program) const noexcept;
    void call_hook(std::size_t program);
    void run_hook(std::size_t program, Handshake asked);
    /// As of this cycle.
    [[nodiscard]] bool slow_tasks_at_rest(std::size_t program) const noexcept;
    void tell_fault(std::size_t program, std::string words);
    // program_tasks.cpp
    void run_base_task(BaseTask& base, std::uint32_t missed_ticks) noexcept;
    void release_slow_task(SlowPlace& slow) noexcept;
    /// Its program stops when it does not keep its time.
    void judge(SlowPlace& slow) noexcept;
    [[nodiscard]] double milliseconds(std::uint64_t cycles) const noexcept;
    void raise_alarms_of_task(const SlowPlace& slow) noexcept;
    void write_values_at_rest() noexcept;
    void raise_alarms_of(std::size_t program) noexcept;
    /// What the task was told of its times, where somebody records them: it has asked.
    void record_times(std::size_t place, const TaskInfo& told) noexcept;

    MachineBody& body_;
    HandMotion& hands_;
    ProgramHost host_;
    OperatorValues values_;
    RetainedImage retained_;
    std::vector<bool> kept_by_slow_;  // as host_.retained()
    std::vector<AxisClaims> claims_;  // per axis
    WatchedGroups groups_;
    ProgramRecords programs_;
    ObjectRequests objects_;
    std::vector<BaseTask> base_tasks_;
    std::vector<SlowPlace> slow_tasks_;
    TaskTimes times_;  // of host_.tasks()
    LongestTask longest_base_task_;
    std::vector<double> variable_values_;       // as this cycle shows them
    std::vector<bool> shown_by_slow_;           // which of them are read after a slow task's run
    std::atomic<std::int32_t> pulse_task_{-1};  // of host_.tasks()
    std::atomic<std::int32_t> at_hooks_{-1};    // program whose start() or stop() runs
    mutable std::mutex fault_words_;            // of ProgramHost::Loaded::fault: written beside the service thread
};

}  // namespace taktwerk::runtime
