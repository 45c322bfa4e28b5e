#pragma once
// A bus whose residents are a servo 'a' and terminals 'b', 'c' in a line, and a tool that comes and goes: a terminal 'd' that is known by its
// alias, and a servo 'e' behind it, in group "tool".

#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {

inline constexpr std::uint16_t tool_alias = 100;

/// Sockets that stay free on this bus.
enum class Socket : std::uint8_t {
    side_of_first,  ///< port 3 of 'a': in front of the others in the order of processing
    side_of_last,   ///< port 3 of 'c'
    end,            ///< port 1 of 'c': behind all
};

class HotConnectBus : public TestBus {
public:
    explicit HotConnectBus(Socket socket = Socket::side_of_last, Duration cycle = 1ms) : TestBus("stt", cycle) {
        auto& parent = network.slave(socket == Socket::side_of_first ? 0 : 2);
        tool_ = &add_tool(parent, socket == Socket::end ? 1 : 3, tool_alias);
        config.slaves.push_back(slave("d", terminal_description(), "tool"));
        config.slaves.back().alias = tool_alias;
        config.slaves.push_back(slave("e", servo_description(), "tool"));
        config.slaves.back().dc = true;
    }

    static SlaveConfig slave(const std::string& name, std::shared_ptr<DeviceDescription> device, const std::string& group) {
        SlaveConfig slave;
        slave.name = name;
        slave.device = std::move(device);
        slave.hot_connect = group;
        return slave;
    }
    /// Its head; the servo hangs behind it.
    sim::SimSlave& add_tool(sim::SimSlave& parent, unsigned port, std::uint16_t alias) {
        sim::SlaveOptions options;
        options.alias = alias;
        options.clock_start = 77'777s;
        auto& head = network.add_behind(parent, port, terminal_description(), std::make_unique<InvertingTerminal>(), options);
        options.alias = 0;
        options.clock_start = 5s;
        tool_servo_ = &network.add_behind(head, 1, servo_description(), std::make_unique<EchoServo>(), options);
        return head;
    }

    void plug(bool in) { plug(*tool_, in); }
    void plug(sim::SimSlave& head, bool in) {
        network.set_cable(head, in);
        transport.lose_under_way(now);
    }
    [[nodiscard]] GroupPresence presence() const { return master->group_presence(0); }
    [[nodiscard]] bool joins(Duration limit = 3s) {
        return run_until([&] { return presence() == GroupPresence::present; }, limit);
    }
    sim::SimSlave& tool() { return *tool_; }
    EchoServo& tool_servo() { return dynamic_cast<EchoServo&>(tool_servo_->model()); }
    sim::SimSlave& tool_servo_slave() { return *tool_servo_; }

private:
    sim::SimSlave *tool_ = nullptr, *tool_servo_ = nullptr;
};

}  // namespace taktwerk::ecat::test
