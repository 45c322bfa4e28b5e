#pragma once
// Which real-time priority the thread of each slower task gets.

#include <vector>

#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// The highest that is given without `priority:`. Interrupt threads of the kernel have 50: a task above them could keep the frames of the bus from
/// this computer.
inline constexpr int highest_task_priority = 49;

/// As the machine file says, else by the period: the shortest has the highest, equal ones share one, each longer one has one less, 1 at last (rate
/// monotonic: Liu and Layland, J. ACM 20, 1973). All below the cycle, with one place between for the watch over them. 0: an ordinary thread, for
/// all of them where the cycle is one.
[[nodiscard]] std::vector<int> task_priorities(const std::vector<TaskConfig>& slower, int cycle_priority);

}  // namespace taktwerk::runtime
