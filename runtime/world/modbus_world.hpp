#pragma once
// The simulated Modbus TCP devices of a machine, and what the field gives their inputs.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "modbus/tcp/simulated_device.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

class ModbusWorld {
public:
    explicit ModbusWorld(const MachineConfig& config);

    /// As many as the configuration has, in its order; for Machine::build; whoever reaches the real device takes another one.
    [[nodiscard]] std::vector<modbus::tcp::Exchange*> exchanges() const;

    /// Raw word of a named point; false: none of these devices has it. Any thread.
    bool set_input(std::string_view point, std::int64_t value) noexcept;
    [[nodiscard]] bool is_single_bit(std::string_view input) const noexcept;
    /// Raw word that a named output has at its device; nothing: none of these devices has it.
    [[nodiscard]] std::optional<std::int64_t> output(std::string_view point) const noexcept;
    /// nullptr: there is none of that name.
    [[nodiscard]] modbus::tcp::SimulatedDevice* device(std::string_view name) const noexcept;

private:
    struct Point {
        IoPoint config;
        modbus::tcp::SimulatedDevice* device;
    };
    struct Place {
        std::string name;
        std::unique_ptr<modbus::tcp::SimulatedDevice> device;
    };
    [[nodiscard]] const Point* find(std::string_view point, IoDirection direction) const noexcept;
    std::vector<Place> devices_;
    std::vector<Point> points_;
};

}  // namespace taktwerk::runtime
