#pragma once
// Which values of the machine are offered to Modbus TCP clients, and as which registers. Plain data; config/ fills it. What is wrong with it:
// hmi_bridge/modbus/shown_value.hpp.

#include <cstdint>
#include <string>
#include <vector>

#include "modbus/server/served_register.hpp"
#include "modbus/server/server_config.hpp"

namespace taktwerk::hmi {

/// A value of the machine by its name.
struct ShownValue {
    enum class Of : std::uint8_t { none, machine, input, output, axis, variable, parameter };
    enum class What : std::uint8_t {
        value,  ///< of an input, an output, a variable or a parameter: itself
        // of an input
        good,
        // of an axis
        position,
        velocity,
        set_position,
        set_velocity,
        torque,
        following_error,
        state,
        error,
        powered,
        homed,
        in_position,
        // of the machine, and of an axis
        alarm,
        // of the machine
        heartbeat,
        phase,
        mode,
        emergency_stop,
        alarms,
    };
    Of of = Of::none;
    What what = What::value;
    std::string name{};  ///< of the point, the axis; "program.variable", "program.parameter"
};

/// One register that shows one value: register = value * factor + offset.
struct ModbusPoint {
    modbus::server::ServedRegister place;
    ShownValue shows;
    bool scaled = false;  ///< with a `scale`, whose `from` is in `unit`
    std::string unit{};   ///< empty: without one
    double factor = 1, offset = 0;
    double register_low = 0, register_high = 0;  ///< with a `scale`: the ends of its `to`, in this order or the other
    std::string where{};                         ///< "machine.yaml:12:5", for what is found out when its program has been loaded
};

struct ModbusServerConfig {
    modbus::server::ServerConfig server;
    std::vector<ModbusPoint> points;
};

}  // namespace taktwerk::hmi
