// The drives on serial lines: who stands on which, the outputs that watch over them, what they say in the recording.

#include <fmt/format.h>

#include "runtime/inbox_record.hpp"
#include "runtime/machine_impl.hpp"

namespace taktwerk::runtime {

namespace {

/// The first axis that moves by a drive on this line; nullptr: nobody needs it, all of its axes are simulated.
const AxisBinding* axis_on(const MachineConfig& config, const SerialLineConfig& line) {
    for (const auto& binding : config.axes)
        for (const auto& entry : line.drives)
            if (!binding.drive.empty() && !binding.axis.simulated && binding.drive == entry.drive.name) return &binding;
    return nullptr;
}

}  // namespace

/// `lines`: one per line of the configuration, nullptr where nobody needs it. An axis that believes to move while no line carries its speeds
/// would be worse than none.
void Machine::Impl::build_lines(const std::vector<modbus::SerialLine*>& serial_lines, std::vector<Error>& errors) {
    for (std::size_t i = 0; i < config.serial.size(); ++i) {
        auto* line = i < serial_lines.size() ? serial_lines[i] : nullptr;
        lines.push_back(line ? std::make_unique<axes::xp200::DriveLine>(*line) : nullptr);
        const auto* axis = line ? nullptr : axis_on(config, config.serial[i]);
        if (axis == nullptr) continue;
        errors.push_back(
            {"serial.no_line", "serial." + config.serial[i].name,
             fmt::format("axis '{}' moves by drive '{}' on this line, and nothing was opened for it", axis->axis.name, axis->drive),
             "name its port in `device`, or write `simulated: true` under the axis; a program that builds the machine itself hands "
             "Machine::build a line for each entry of `serial`"});
    }
}

/// The binding's drive, appended to `ports`; nullptr when the axis is on no line, or simulated.
axes::xp200::Xp200Drive* Machine::Impl::serial_drive(const AxisBinding& binding) {
    if (binding.drive.empty() || binding.axis.simulated) return nullptr;
    for (std::size_t i = 0; i < config.serial.size(); ++i)
        for (const auto& entry : config.serial[i].drives) {
            if (entry.drive.name != binding.drive || !entry.drive.profile || !lines[i]) continue;
            auto drive_config = entry.drive;
            drive_config.counts_per_turn = binding.axis.gearing.counts_per_revolution;
            drive_config.has_watchdog_output = !entry.watchdog_output.empty();
            auto drive = std::make_unique<axes::xp200::Xp200Drive>(std::move(drive_config), config.serial[i].settings);
            lines[i]->add(*drive);
            serial_drives.push_back(drive.get());
            recorded_samples.push_back(0);
            if (const int output = io.find(IoDirection::output, entry.watchdog_output); output >= 0)
                watchdog_outputs.push_back({static_cast<std::size_t>(output), drive.get()});
            ports.push_back(std::move(drive));
            return serial_drives.back();
        }
    return nullptr;
}

/// On while the line is heard and the drive is as configured. Whatever a program wrote there: the output has one writer. When the PC is dead
/// it falls by the terminal's own SM watchdog.
void Machine::Impl::hold_watchdog_outputs() noexcept {
    for (const auto& watchdog : watchdog_outputs) io.outputs()[watchdog.output] = watchdog.drive->supervised(now) ? 1 : 0;
}

void Machine::Impl::record_samples() noexcept {
    for (std::size_t i = 0; i < serial_drives.size(); ++i) {
        const auto& sample = serial_drives[i]->newest();
        if (sample.revision == recorded_samples[i]) continue;
        recorded_samples[i] = sample.revision;
        record_sample(*recorder, now, static_cast<std::uint16_t>(i), sample);
    }
}

}  // namespace taktwerk::runtime
