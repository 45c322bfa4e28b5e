#pragma once
// Lines and devices that a replayed machine is built with and that nobody asks: what they said is in the recording.

#include <memory>
#include <vector>

#include "modbus/line/serial_line.hpp"
#include "modbus/tcp/exchange.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

class StandIns {
public:
    explicit StandIns(const MachineConfig& config);
    /// As Machine::build takes them; they live as long as this.
    [[nodiscard]] std::vector<modbus::SerialLine*> lines() const;
    [[nodiscard]] std::vector<modbus::tcp::Exchange*> exchanges() const;

private:
    class Line;
    class Device;
    std::vector<std::unique_ptr<modbus::SerialLine>> lines_;
    std::vector<std::unique_ptr<modbus::tcp::Exchange>> devices_;
};

}  // namespace taktwerk::runtime
