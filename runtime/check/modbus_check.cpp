#include "runtime/check/modbus_check.hpp"

#include <algorithm>

#include "modbus/tcp/tcp_exchange.hpp"
#include "runtime/check/problems.hpp"

namespace taktwerk::runtime {

namespace {

using modbus::tcp::Channel;
using modbus::tcp::DeviceConfig;

class ModbusCheck {
public:
    ModbusCheck(const MachineConfig& config, std::vector<Error>& errors) : config_(config), problems_(errors) {}

    void run() {
        if (config_.modbus.empty()) return;
        std::vector<std::string> names;
        for (const auto& slave : config_.bus.slaves) names.push_back(slave.name);
        for (const auto& device : config_.modbus) {
            if (std::ranges::find(names, device.name) != names.end())
                problems_.add("config.duplicate_name", "modbus_tcp." + device.name, "a slave or another device has this name too",
                              "choose different names");
            names.push_back(device.name);
            check_device(device);
            check_twin(device);
        }
        check_users();
    }

private:
    void check_device(const DeviceConfig& device) {
        const auto here = "modbus_tcp." + device.name;
        if (!device.host.empty() && !modbus::tcp::is_address(device.host))
            problems_.add("modbus.host", here + ".host", fmt::format("'{}' is no IPv4 or IPv6 address", device.host),
                          "write the address itself, such as 192.168.1.50; a name would have to be looked up, which may take any time");
        if (device.unit == 0 || (device.unit > 247 && device.unit != 255))
            problems_.add("modbus.unit", here + ".unit",
                          fmt::format("{} is no unit that answers: 0 is for all, 248 to 254 are reserved", device.unit),
                          "use 1 to 247 as the device says, or 255 for one without a gateway");
        if (device.timeout <= Duration{} || device.timeout > DeviceConfig::longest_timeout)
            problems_.add("modbus.timeout", here + ".timeout", "a timeout is at most 2 s, or the end of a run would wait for too long",
                          "use for instance 200 ms");
        if (device.max_age < device.poll)
            problems_.add("modbus.max_age", here + ".max_age", "inputs would be too old before they are read again",
                          "make it several times `poll`, such as `poll: 20 ms, max_age: 100 ms`");
        for (const auto& channel : device.channels) check_channel(device, channel);
    }

    /// Two that ask one unit overwrite each other, and many devices serve one client only.
    void check_twin(const DeviceConfig& device) {
        if (device.host.empty()) return;
        for (const auto& other : config_.modbus) {
            if (&other == &device) break;
            if (other.host == device.host && other.port == device.port && other.unit == device.unit)
                problems_.add("modbus.same_device", "modbus_tcp." + device.name + ".host",
                              fmt::format("'{}' asks unit {} at {} port {} already", other.name, other.unit, other.host, other.port),
                              "list all registers under one of them, or correct `host`, `port` or `unit`");
        }
    }

    void check_channel(const DeviceConfig& device, const Channel& channel) {
        const auto here = fmt::format("modbus_tcp.{}.registers.{}", device.name, channel.name);
        if (channel.use != Channel::Use::written) return;
        if (!is_writable(channel.table))
            problems_.add("modbus.read_only", here + ".table", "an output uses it, and this table cannot be written",
                          "choose `coil` or `holding`, as the device's manual says");
        if (channel.type == modbus::tcp::NumberType::boolean && !is_bits(channel.table))
            problems_.add("modbus.bit_written", here + ".bit",
                          "one bit of a register cannot be written alone: the others would fall with it",
                          "write the whole register as a uint16, or use a coil where the device has one");
        for (const auto& other : device.channels) {
            if (&other == &channel) break;
            const unsigned begin = channel.address, end = begin + addresses_of(channel.type);
            const unsigned from = other.address, to = from + addresses_of(other.type);
            if (other.use == Channel::Use::written && other.table == channel.table && begin < to && from < end)
                problems_.add("modbus.written_twice", here + ".address",
                              fmt::format("'{}' writes the same address: two outputs would overwrite each other", other.name),
                              "give each output addresses of its own");
        }
    }

    /// A value that is polled is tens of milliseconds old, and its network may be anybody's.
    void check_users() {
        refuse(config_.emergency_stop.input, IoDirection::input, "emergency_stop.input");
        for (const auto& binding : config_.axes) {
            const auto here = "axes." + binding.axis.name;
            refuse(binding.load_input, IoDirection::input, here + ".load_encoder.input");
            refuse(binding.brake_output, IoDirection::output, here + ".brake.output");
            if (!binding.analog) continue;
            const auto& wires = *binding.analog;
            refuse(wires.setpoint, IoDirection::output, here + ".analog.setpoint");
            refuse(wires.enable, IoDirection::output, here + ".analog.enable");
            refuse(wires.reset, IoDirection::output, here + ".analog.reset");
            refuse(wires.ready, IoDirection::input, here + ".analog.ready");
            refuse(wires.fault, IoDirection::input, here + ".analog.fault");
            refuse(wires.negative_limit, IoDirection::input, here + ".analog.negative_limit");
            refuse(wires.positive_limit, IoDirection::input, here + ".analog.positive_limit");
            refuse(wires.home_switch, IoDirection::input, here + ".analog.home_switch");
        }
        for (const auto& line : config_.serial)
            for (const auto& entry : line.drives)
                refuse(entry.watchdog_output, IoDirection::output,
                       fmt::format("serial.{}.drives.{}.watchdog_output", line.name, entry.drive.name));
    }

    void refuse(const std::string& name, IoDirection direction, const std::string& subject) {
        for (const auto& point : config_.io)
            if (!name.empty() && point.name == name && point.direction == direction && point.beside)
                problems_.add("modbus.not_for_this", subject,
                              fmt::format("'{}' is on Modbus device '{}', which is polled beside the cycle over a network without "
                                          "authentication",
                                          name, point.slave),
                              "use a terminal on the bus");
    }

    const MachineConfig& config_;
    Problems problems_;
};

}  // namespace

void check_modbus(const MachineConfig& config, std::vector<Error>& errors) { ModbusCheck{config, errors}.run(); }

}  // namespace taktwerk::runtime
