#pragma once
// Which machine of this computer drives a network interface or a serial device: who wants to speak there directly must not.

#include <optional>
#include <string>

namespace taktwerk::apps {

struct RunningMachine {
    std::string name, socket;
    int process = 0;
};

/// `port`: "eth1", "/dev/ttyUSB0". `further_socket`: looked at besides the usual folders; may be empty. Machines that do not answer
/// within half a second do not count. Not real-time.
[[nodiscard]] std::optional<RunningMachine> machine_on(const std::string& port, const std::string& further_socket);

}  // namespace taktwerk::apps
