#pragma once
// What a task was told of its times (TaskContext::task()), as bytes of a Recorder: measured, so no machine can compute it again. Written only when
// the task has asked, behind the scan of a base task, before the `slow` record of a slower one. Little-endian, by the cycle thread.
//
//   task_times   u16 task, u64 overruns, i64 ns each: last, minimum, maximum, mean run; lateness, its maximum        58 bytes

#include <cstdint>

#include "programs/api/task_info.hpp"
#include "runtime/recording/inbox_record.hpp"

namespace taktwerk::runtime {

inline constexpr RecordChannel task_times_channel = 24;

struct TaskTimesRecord {
    std::uint16_t task = 0;  ///< of MachineLayout::tasks
    std::uint64_t overruns = 0;
    TaskInfo::Times run{};
    Duration lateness{}, lateness_max{};

    [[nodiscard]] static TaskTimesRecord of(std::uint16_t task, const TaskInfo& info) noexcept {
        return {task, info.overruns, info.run, info.lateness, info.lateness_max};
    }
    void tell(TaskInfo& info) const noexcept {
        info.overruns = overruns;
        info.run = run;
        info.lateness = lateness;
        info.lateness_max = lateness_max;
    }
};

inline void record_task_times(Recorder& recorder, Instant at, const TaskTimesRecord& record) noexcept {
    inbox_record::Bytes<58> bytes;
    bytes.put(record.task);
    bytes.put(record.overruns);
    for (const auto time : {record.run.last, record.run.minimum, record.run.maximum, record.run.mean, record.lateness, record.lateness_max})
        bytes.put(static_cast<std::int64_t>(time.count()));
    recorder.append(task_times_channel, at, bytes.all());
}

}  // namespace taktwerk::runtime
