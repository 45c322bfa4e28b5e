#pragma once
// Between the machine's points and the ports of analog drives: what their amplifiers say, and what they are given.

#include <memory>
#include <string>
#include <vector>

#include "axes/drives/analog/analog_port.hpp"
#include "runtime/machine/machine_body.hpp"

namespace taktwerk::runtime {

class AnalogWires {
public:
    explicit AnalogWires(MachineBody& body) noexcept : body_(body) {}

    /// `binding.analog` is there.
    [[nodiscard]] std::unique_ptr<axes::DrivePort> add(const AxisBinding& binding, std::unique_ptr<axes::DrivePort> encoder);
    void join_capabilities() noexcept;

    /// Real-time safe, both: after the inputs were read, and before the outputs are written, whatever a program wrote there.
    void read() noexcept;
    void write() noexcept;

private:
    struct Wires {
        axes::analog::AnalogPort* port;
        bool has_switches;
        // Index of the point; -1: not wired.
        int setpoint, enable, reset;
        int ready, fault, negative_limit, positive_limit, home_switch;
        std::vector<std::size_t> slaves;  // of all of them
        std::uint32_t patience;           // cycles that one of them may not be exchanged
    };
    [[nodiscard]] int point(IoDirection direction, const std::string& name, std::vector<std::size_t>& slaves) const;
    [[nodiscard]] bool reachable(const Wires& wires) const noexcept;
    [[nodiscard]] bool on(int input) const noexcept { return body_.io.inputs()[static_cast<std::size_t>(input)] != 0; }

    MachineBody& body_;
    std::vector<Wires> wires_;
};

}  // namespace taktwerk::runtime
