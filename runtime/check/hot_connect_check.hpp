#pragma once
// What cannot work of groups that join and leave: something that stands with one foot in a group, or that the whole machine needs.

#include <vector>

#include "core/result.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

void check_hot_connect(const MachineConfig& config, std::vector<Error>& errors);

}  // namespace taktwerk::runtime
