#pragma once
// A task at a divisor of the cycle: latches its inputs at release, its outputs apply at its next release, whenever it finishes.
// Therefore real time (a thread of its own) and virtual time (called after the cycle) agree by construction.
//
//   cycle thread: release(), finished()      task thread: run_if_released()

#include <atomic>
#include <cstdint>
#include <vector>

#include "core/cycle_context.hpp"
#include "core/stopwatch.hpp"
#include "runtime/recording/task_times_record.hpp"
#include "runtime/tasks/fault_text.hpp"
#include "runtime/tasks/latched_requests.hpp"
#include "runtime/tasks/memory_copy.hpp"
#include "runtime/tasks/program_host.hpp"
#include "runtime/tasks/variable_copy.hpp"

namespace taktwerk::runtime {

class SlowTask {
public:
    enum class State : std::uint8_t { idle, released, running, done };
    /// What a person has given: stands in the variable when the run begins.
    struct Write {
        VariableType type = VariableType::real;
        void* address = nullptr;
        double value = 0;
    };

    /// A block whose bytes were kept, before the first scan of its task.
    struct WarmBlock {
        const fb::BlockType* type = nullptr;
        void* address = nullptr;
    };

    /// `writes`: how many operator values are the task's; `kept`: what of its memory is to be kept over a time without power.
    SlowTask(const ProgramHost::Task& task, Program* program, std::vector<ProgramHost::Variable> variables, std::size_t axes,
             std::size_t inputs, std::size_t outputs, std::size_t parameters, ObjectAccess& objects, axes::MotionTables& tables,
             std::size_t writes = 0, std::vector<MemoryCopy::Source> kept = {});
    /// Before its first run, which begins with them. Not real-time.
    void add_warm_block(const WarmBlock& block) { given_.warm.push_back(block); }

    // --- cycle thread ---------------------------------------------------------------------------------------------------------
    [[nodiscard]] bool due(std::uint64_t cycle) const noexcept { return cycle % divisor_ == 0; }
    /// Not started, or ended: it may be released again.
    [[nodiscard]] bool finished() const noexcept {
        const auto state = state_.load(std::memory_order_acquire);
        return state == State::idle || state == State::done;
    }
    /// Bits of each output point and what they mean, known once the bus has laid out its image. Before the first release.
    void learn_outputs(std::span<const std::uint8_t> bits, std::span<const PointLine> lines) noexcept { image_ = {bits, lines}; }
    /// The input points of a cycle: raw words, and what they mean.
    struct Inputs {
        std::span<const std::int64_t> words;
        std::span<const PointValue> values;
    };
    /// What the last run wrote goes to the machine; only outputs and alarms that it changed.
    void apply(axes::AxisRequests& axes, std::span<std::int64_t> outputs, std::uint64_t& program_alarms) noexcept;
    void renew(axes::AxisRequests& axes) noexcept { requests_.renew(axes); }
    /// Room for what the next run is to find in its operator values; then how much of it is filled. Before release().
    [[nodiscard]] std::span<Write> writes() noexcept { return given_.writes; }
    void set_write_count(std::size_t count) noexcept { given_.count = count; }
    /// What the next run is told of its task. Before release().
    void tell(const TaskInfo& info) noexcept { times_.told = info; }
    /// For a replay: released, not yet run.
    void tell_again(const TaskTimesRecord& then) noexcept { then.tell(times_.told); }
    /// Only while finished(): the last run has asked what it was told.
    [[nodiscard]] bool times_asked() const noexcept { return times_.asked; }
    [[nodiscard]] const TaskInfo& info() const noexcept { return times_.told; }
    /// Latches everything and hands the task to its thread.
    void release(const CycleContext& now, std::span<const axes::AxisView> views, const Inputs& inputs,
                 std::span<const std::int64_t> outputs, std::span<const double> parameters, std::uint64_t program_alarms) noexcept;
    /// Values of the program's variables as the last applied run left them; for programs without a base task.
    [[nodiscard]] std::span<const double> variables() const noexcept { return left_.variables.applied(); }
    /// What is kept of its memory, one after the other, as the last applied run left it. Nothing was applied since the program's start: empty.
    [[nodiscard]] std::span<const std::byte> kept() const noexcept {
        return left_.kept_fresh ? left_.kept.applied() : std::span<const std::byte>{};
    }
    /// They were written to while the program rests. Only while finished().
    void show_variables() noexcept {
        left_.variables.read();
        left_.variables.apply();
    }
    /// How many runs have been applied.
    [[nodiscard]] std::uint64_t applied() const noexcept { return applied_; }
    [[nodiscard]] Duration last_run() const noexcept { return times_.run; }
    /// From its release to its first instruction.
    [[nodiscard]] Duration last_lateness() const noexcept { return times_.lateness; }
    /// Only while finished().
    [[nodiscard]] bool threw() const noexcept { return threw_; }
    [[nodiscard]] const FaultText& fault() const noexcept { return fault_; }
    [[nodiscard]] TaskContext::Undeclared undeclared() const noexcept { return undeclared_; }
    [[nodiscard]] std::size_t program() const noexcept { return task_.program; }
    [[nodiscard]] const TaskConfig& config() const noexcept { return task_.config; }
    /// The program was stopped: what its last run asked for is not carried out. Only while finished().
    void forget() noexcept;
    /// The program starts (again): forgets, and the next run is its first scan. Only while finished().
    void restart() noexcept;

    // --- task thread, or between cycles in virtual time -----------------------------------------------------------------------
    /// True when there was something to do.
    bool run_if_released() noexcept;
    /// Scan time of the cycle that released the last run.
    [[nodiscard]] Instant last_release() const noexcept { return times_.released; }

private:
    ProgramHost::Task task_;
    Program* program_;
    std::uint64_t divisor_;
    struct {
        VariableCopy variables;
        MemoryCopy kept;
        bool kept_fresh = false;  // applied since the program's start
    } left_;                      // of its memory, by a run
    std::atomic<State> state_{State::idle};
    LatchedRequests requests_;
    ObjectAccess& objects_;
    axes::MotionTables& tables_;
    std::vector<axes::AxisView> views_;
    std::vector<std::int64_t> inputs_, outputs_, outputs_at_release_;
    std::vector<PointValue> input_values_;
    struct {
        std::span<const std::uint8_t> bits;
        std::span<const PointLine> lines;
    } image_;  // of the outputs
    std::vector<double> parameters_;
    struct {
        std::vector<Write> writes;  // by people ...
        std::size_t count = 0;      // ... so many
        std::vector<WarmBlock> warm;
    } given_;  // for the next run
    CycleContext context_;
    std::uint64_t runs_ = 0, applied_ = 0, alarms_ = 0, alarms_at_release_ = 0;
    bool threw_ = false;
    FaultText fault_;
    TaskContext::Undeclared undeclared_;
    struct {
        TaskInfo told;  // to the run
        bool asked = false;
        Stopwatch since_release;
        Duration run{}, lateness{};
        Instant released{};
    } times_;
};

}  // namespace taktwerk::runtime
