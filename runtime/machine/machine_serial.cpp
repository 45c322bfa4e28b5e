// The drives on serial lines: who stands on which, the outputs that watch over them, what they say in the recording.

#include <algorithm>

#include <fmt/format.h>

#include "axes/drives/xp200/line_codes.hpp"
#include "runtime/machine/machine_impl.hpp"
#include "runtime/recording/inbox_record.hpp"

namespace taktwerk::runtime {

namespace {

/// The first axis that moves by a drive on this line; nullptr: nobody needs it, all of its axes are simulated.
const AxisBinding* axis_on(const MachineConfig& config, const SerialLineConfig& line) {
    for (const auto& binding : config.axes)
        for (const auto& entry : line.drives)
            if (!binding.drive.empty() && !binding.axis.simulated && binding.drive == entry.drive.name) return &binding;
    return nullptr;
}

/// A drive takes 1.5 s to start (XP200 manual 4.1), and its line asks it every half second.
constexpr Duration silent_for = std::chrono::seconds{5};
/// Stopping it, reading and writing its settings takes about a second; on a slow line that several drives share some more.
constexpr Duration not_ready_for = std::chrono::seconds{30};

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
            serial_watches.push_back({static_cast<std::uint16_t>(ports.size()), entry.drive.station, Instant{}});
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

/// An axis whose drive was never heard has nothing to lose, and no alarm of its own; nor has one without power whose drive falls silent.
void Machine::Impl::watch_serial_drives() noexcept {
    for (std::size_t i = 0; i < serial_drives.size(); ++i) {
        const auto& sample = serial_drives[i]->newest();
        auto& watch = serial_watches[i];
        if (sample.online || watch.online == Instant{}) watch.online = now;
        const auto since_heard = now - std::max(sample.heard, watch.online), since_online = now - watch.online;
        if (since_heard >= silent_for)
            raise(MachineAlarm::drive_silent, AlarmSource::axis, watch.axis, watch.station, to_seconds(silent_for));
        else if (since_online >= not_ready_for)
            raise(MachineAlarm::drive_not_ready_on_line, AlarmSource::axis, watch.axis, watch.station, to_seconds(not_ready_for));
    }
}

std::string Machine::Impl::line_of(std::size_t axis) const {
    for (const auto& line : config.serial)
        for (const auto& entry : line.drives)
            if (axis < config.axes.size() && config.axes[axis].drive == entry.drive.name)
                return fmt::format(" of line '{}' ({}, {} baud, {})", line.name, line.device.empty() ? "simulated" : line.device,
                                   line.settings.baud, axes::xp200::format_text(line.settings));
    return {};
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
