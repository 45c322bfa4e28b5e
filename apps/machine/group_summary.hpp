#pragma once
// What `check` says of groups that join and leave: what is in them, by what they are known, what holds while they are away.

#include <string>
#include <vector>

#include "runtime/machine_config.hpp"

namespace taktwerk::apps {

struct GroupSummary {
    std::string name;
    std::string known_by;  ///< "alias 17", "device id 3"
    std::vector<std::string> slaves, axes, inputs, outputs;
    std::vector<std::string> when_absent;  ///< sentences
};

[[nodiscard]] std::vector<GroupSummary> group_summaries(const runtime::MachineConfig& config);

/// "position 2", "alias 17", "device id 3", "in group tool_a".
[[nodiscard]] std::string place_of(const ecat::SlaveConfig& slave);

}  // namespace taktwerk::apps
