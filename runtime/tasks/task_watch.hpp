#pragma once
// Whether a slower task keeps its time, counted in cycles of the machine: in virtual time and in a replay the verdict is the same as in the run
// itself, and a computer that stood still for a while accuses nobody. Used on the cycle's thread. Real-time safe.

#include <algorithm>
#include <cstdint>

#include "core/time.hpp"
#include "runtime/machine_config.hpp"
#include "runtime/relaxed_supervision.hpp"

namespace taktwerk::runtime {

/// What its program has done wrong.
enum class TaskVerdict : std::uint8_t {
    in_time,
    late,     ///< missed more releases in a row than allowed; by OverrunReaction::stop_program its program ends
    watchdog  ///< a run took longer than its watchdog allows
};

class TaskWatch {
public:
    /// Without a `watchdog`: ten periods, and at least this; where supervision is relaxed ten times as long.
    static constexpr Duration shortest_default = std::chrono::milliseconds{250};
    static constexpr int periods_by_default = 10, relaxed_watchdog_factor = 10;

    /// How long one run may take; 0: no limit.
    [[nodiscard]] static Duration watchdog_of(const TaskConfig& task, const MachineConfig& machine) noexcept {
        return task.watchdog.value_or(default_of(task, machine));
    }
    /// How long a run of a task without a limit (`watchdog: 0 ms`) may go on once a person has stopped its program.
    [[nodiscard]] static Duration default_of(const TaskConfig& task, const MachineConfig& machine) noexcept {
        const auto strict = std::max(shortest_default, machine.cycle * static_cast<Duration::rep>(task.divisor) * periods_by_default);
        return machine.simulation.supervision == Supervision::relaxed ? strict * relaxed_watchdog_factor : strict;
    }
    /// Releases that it may miss in a row.
    [[nodiscard]] static std::uint32_t overruns_allowed(const TaskConfig& task, const MachineConfig& machine) noexcept {
        return supervised_limit(machine, task.overruns_allowed);
    }

    TaskWatch(const TaskConfig& task, const MachineConfig& machine) noexcept
        : watchdog_(cycles_in(watchdog_of(task, machine), machine)),
          behind_stop_(cycles_in(default_of(task, machine), machine)),
          sensitivity_(std::max<std::uint16_t>(1, task.watchdog_sensitivity)),
          overruns_allowed_(overruns_allowed(task, machine)),
          late_counts_(task.overrun == OverrunReaction::stop_program) {}

    /// Released in this cycle.
    void begin(std::uint64_t cycle) noexcept {
        released_ = cycle;
        at_work_ = true;
        left_ = 0;
    }
    /// In each cycle in which it is still at work and its program is stopped.
    void left_behind() noexcept { ++left_; }
    /// It was due in this cycle and had not ended.
    void missed() noexcept { ++overruns_; }
    /// It was due, and had ended.
    void in_time() noexcept { overruns_ = 0; }
    /// The cycle has taken note that its run has ended.
    void end(std::uint64_t cycle) noexcept {
        at_work_ = false;
        last_ = cycle - released_;
        if (watchdog_ == 0 || last_ <= watchdog_) bites_ = 0;
        else bites_ = last_ > watchdog_ * sensitivity_ ? sensitivity_ : bites_ + 1;
    }
    /// Its program starts anew.
    void forgive() noexcept {
        overruns_ = 0;
        bites_ = 0;
    }
    /// As of this cycle.
    [[nodiscard]] TaskVerdict verdict(std::uint64_t cycle) const noexcept {
        const bool too_often = bites_ >= sensitivity_;
        const bool much_too_long = at_work_ && watchdog_ > 0 && cycle - released_ > watchdog_ * sensitivity_;
        const bool never_back = at_work_ && watchdog_ == 0 && left_ > behind_stop_;
        if (too_often || much_too_long || never_back) return TaskVerdict::watchdog;
        return late_counts_ && overruns_ > overruns_allowed_ ? TaskVerdict::late : TaskVerdict::in_time;
    }
    /// Releases that it has missed in a row.
    [[nodiscard]] std::uint32_t overruns() const noexcept { return overruns_; }
    [[nodiscard]] std::uint32_t overruns_allowed() const noexcept { return overruns_allowed_; }
    /// So many cycles the run takes that is at work, else the last one.
    [[nodiscard]] std::uint64_t cycles_taken(std::uint64_t cycle) const noexcept { return at_work_ ? cycle - released_ : last_; }
    /// What it was judged by, in cycles: of a run; without a limit: from the stop of its program on.
    [[nodiscard]] std::uint64_t watchdog() const noexcept { return watchdog_ > 0 ? watchdog_ : behind_stop_; }

private:
    [[nodiscard]] static std::uint64_t cycles_in(Duration time, const MachineConfig& machine) noexcept {
        return static_cast<std::uint64_t>((time + machine.cycle - Duration{1}) / machine.cycle);
    }

    std::uint64_t watchdog_, behind_stop_;
    std::uint32_t sensitivity_;
    std::uint32_t overruns_allowed_;
    bool late_counts_;
    bool at_work_ = false;
    std::uint32_t overruns_ = 0;
    std::uint32_t bites_ = 0;
    std::uint64_t released_ = 0, last_ = 0, left_ = 0;
};

}  // namespace taktwerk::runtime
