#pragma once
// What an axis over +-10 V needs of the machine and of its own configuration; its encoder is looked at elsewhere (axis_check.cpp).

#include <set>
#include <string>

#include "runtime/check/problems.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// `binding.analog` is there. `outputs`: those that axes drive; its own are added.
void check_analog(const MachineConfig& config, const AxisBinding& binding, const std::string& subject, std::set<std::string>& outputs,
                  Problems& problems);

/// What is right and still mostly not meant, as remarks.
[[nodiscard]] std::vector<Error> analog_remarks(const AxisBinding& binding, const std::string& subject);

}  // namespace taktwerk::runtime
