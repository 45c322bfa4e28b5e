#pragma once
// How long the tasks took and how late they were: for people, for the tasks themselves, and what of it a recording has. The cycle's, but for what
// says otherwise. Real-time safe.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/shared_histogram.hpp"
#include "programs/api/task_info.hpp"
#include "runtime/recording/task_times_record.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::runtime {

class TaskTimes {
public:
    /// One for each of MachineLayout::tasks.
    explicit TaskTimes(std::size_t tasks) : statistics_(tasks), runs_(tasks), lateness_(tasks), replayed_(tasks) {}

    /// A run is over, in the cycle of this number.
    void book(std::size_t task, Duration run, Duration lateness, std::uint64_t cycle) noexcept {
        statistics_[task].book(run, lateness);
        runs_[task].record(run, cycle);
        lateness_[task].record(lateness, cycle);
    }
    void overrun(std::size_t task) noexcept { ++statistics_[task].overruns; }
    /// What was measured begins anew; what was counted goes on.
    void reset() noexcept {
        for (auto& task : statistics_) task.begin_anew();
        for (auto& times : runs_) times.reset();
        for (auto& times : lateness_) times.reset();
    }

    /// In real time: what its task is told is what was measured. Else it is 0, or what replay() says.
    void tell_measured() noexcept { tells_ = true; }
    /// For a replay: what the task was told then. Of a base task: in the scan that follows.
    void replay(const TaskTimesRecord& record) noexcept { replayed_[record.task] = record; }
    [[nodiscard]] TaskInfo info(std::size_t task, Duration period, std::uint32_t missed) noexcept {
        const auto& numbers = statistics_[task];
        TaskInfo info;
        info.period = period;
        info.runs = numbers.releases;
        info.missed = missed;
        if (auto& then = replayed_[task]) {
            then->tell(info);
            then.reset();
        } else if (tells_) {
            info.overruns = numbers.overruns;
            info.run = {numbers.run, numbers.run_min, numbers.run_max, numbers.run_mean()};
            info.lateness = numbers.lateness;
            info.lateness_max = numbers.lateness_max;
        }
        return info;
    }

    [[nodiscard]] const TaskStatistics& of(std::size_t task) const noexcept { return statistics_[task]; }
    [[nodiscard]] const std::vector<TaskStatistics>& statistics() const noexcept { return statistics_; }
    /// Any thread.
    [[nodiscard]] const std::vector<SharedHistogram>& runs() const noexcept { return runs_; }
    [[nodiscard]] const std::vector<SharedHistogram>& lateness() const noexcept { return lateness_; }

private:
    std::vector<TaskStatistics> statistics_;
    std::vector<SharedHistogram> runs_, lateness_;
    std::vector<std::optional<TaskTimesRecord>> replayed_;
    bool tells_ = false;
};

}  // namespace taktwerk::runtime
