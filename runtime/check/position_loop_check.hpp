#pragma once
// The position loop that is closed here: whether its gain suits how often it is closed, and who opens it when the master is gone. Not real-time.

#include <string>
#include <vector>

#include "runtime/check/problems.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// A gain with which the loop cannot be stable. Of other control modes: nothing.
void check_position_loop(const MachineConfig& config, const AxisBinding& binding, const std::string& subject, Problems& problems);

/// A gain that is hardly meant, and of an analog axis: how long its set-point and its enable outlive the master.
[[nodiscard]] std::vector<Error> position_loop_remarks(const MachineConfig& config, const AxisBinding& binding, const std::string& subject);

/// The slave of an output, and the time after which its watchdog takes it away; an empty name where no slave has it.
struct WatchedOutput {
    std::string slave;
    Duration watchdog{};
};
[[nodiscard]] WatchedOutput watchdog_of_output(const MachineConfig& config, const std::string& output);

}  // namespace taktwerk::runtime
