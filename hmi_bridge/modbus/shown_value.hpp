#pragma once
// The names of `modbus_server:` in one machine: what they mean, what is wrong with them, and what they show after a cycle.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "hmi_bridge/modbus_server_config.hpp"
#include "runtime/machine_config.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::hmi {

/// What a machine has to show. Places are those of a snapshot.
struct ShownNames {
    struct Named {
        std::string name, unit;
        bool by_hand = true;  ///< of an output: people may set it; false: an axis or a serial line has it
    };
    std::vector<Named> axes, inputs, outputs;
    std::vector<Named> variables, parameters;  ///< "program.name"
    Duration cycle{};
    bool with_programs = false;  ///< false: what programs have is not known yet, and nothing is said of it
};
/// As far as a configuration knows them: without what programs declare.
[[nodiscard]] ShownNames names_of(const runtime::MachineConfig& config);
/// All of them. Which outputs are not for people stands in the configuration alone.
[[nodiscard]] ShownNames names_of(const runtime::MachineLayout& layout);

/// Where a value stands, and its unit.
struct BoundValue {
    ShownValue::Of of = ShownValue::Of::none;
    ShownValue::What what = ShownValue::What::value;
    std::uint16_t index = 0;
    std::string unit{};
};
/// Nothing: there is no such name.
[[nodiscard]] std::optional<BoundValue> bind(const ShownValue& value, const ShownNames& names);

/// All that is wrong, each with its key as subject: "modbus_server.points.<name>.address". Overlaps, types that do not fit, names that are not
/// there, writable points that nobody may command. With programs those alone which they decide, at the point's place in its file.
[[nodiscard]] std::vector<Error> check(const ModbusServerConfig& config, const ShownNames& names);

/// In its unit; a flag is 0 or 1; alarms and states their numbers (docs/modbus-tcp.md). `place` counts for the heartbeat alone, which wraps where
/// its type ends. Real-time safe.
[[nodiscard]] double value_of(const BoundValue& value, const modbus::server::ServedRegister& place,
                              const runtime::Snapshot& snapshot) noexcept;

/// "axis x position", "input tank_pressure", "heartbeat".
[[nodiscard]] std::string text_of(const ShownValue& value);
[[nodiscard]] std::string_view word(ShownValue::What what) noexcept;

}  // namespace taktwerk::hmi
