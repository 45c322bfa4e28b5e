#include "runtime/run/task_priorities.hpp"

#include <algorithm>
#include <set>

namespace taktwerk::runtime {

std::vector<int> task_priorities(const std::vector<TaskConfig>& slower, int cycle_priority) {
    std::set<std::uint16_t> periods;
    for (const auto& task : slower)
        if (!task.priority) periods.insert(task.divisor);
    const int highest = std::min(highest_task_priority, cycle_priority - 2);
    std::vector<int> out;
    for (const auto& task : slower) {
        const auto shorter = static_cast<int>(std::distance(periods.begin(), periods.find(task.divisor)));
        if (highest < 1) out.push_back(0);
        else out.push_back(task.priority ? *task.priority : std::max(1, highest - shorter));
    }
    return out;
}

}  // namespace taktwerk::runtime
