#include "runtime/machine/kept_points.hpp"

#include <fmt/format.h>

namespace taktwerk::runtime {

KeptPoints kept_points(const MachineConfig& config, const IoImage& io) {
    KeptPoints kept{std::vector<std::string>(io.names(IoDirection::input).size()),
                    std::vector<std::string>(io.names(IoDirection::output).size())};
    const auto keep = [&](IoDirection direction, const std::string& name, std::string why) {
        const int found = name.empty() ? -1 : io.find(direction, name);
        if (found < 0) return;
        auto& reason = (direction == IoDirection::input ? kept.inputs : kept.outputs)[static_cast<std::size_t>(found)];
        if (reason.empty()) reason = std::move(why);
    };
    const auto input = [&](const std::string& name, std::string why) { keep(IoDirection::input, name, std::move(why)); };
    const auto output = [&](const std::string& name, std::string why) { keep(IoDirection::output, name, std::move(why)); };

    input(config.emergency_stop.input, "the emergency stop reads it");
    input(config.emergency_stop.restart, "it is the restart button, which takes a hand at the machine");
    for (const auto& binding : config.axes) {
        const auto& axis = binding.axis.name;
        input(binding.load_input, fmt::format("axis '{}' measures its load by it", axis));
        output(binding.brake_output, fmt::format("it opens the holding brake of axis '{}'", axis));
        if (!binding.analog) continue;
        const auto& wires = *binding.analog;
        for (const auto* name : {&wires.ready, &wires.fault, &wires.negative_limit, &wires.positive_limit, &wires.home_switch})
            input(*name, fmt::format("the drive of axis '{}' is watched by it", axis));
        for (const auto* name : {&wires.setpoint, &wires.enable, &wires.reset})
            output(*name, fmt::format("the drive of axis '{}' hangs on it", axis));
    }
    for (const auto& line : config.serial)
        for (const auto& drive : line.drives)
            output(drive.watchdog_output, fmt::format("it is the watchdog of drive '{}'", drive.drive.name));
    return kept;
}

}  // namespace taktwerk::runtime
