#include "runtime/machine/serial_drives.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "axes/drives/xp200/line_codes.hpp"
#include "axes/drives/xp200/xp200_drive.hpp"
#include "runtime/recording/outcome_record.hpp"

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

SerialDrives::SerialDrives(MachineBody& body, const std::vector<modbus::SerialLine*>& serial_lines, std::vector<Error>& errors)
    : body_(body) {
    const auto& config = body.config;
    for (std::size_t i = 0; i < config.serial.size(); ++i) {
        auto* line = i < serial_lines.size() ? serial_lines[i] : nullptr;
        lines_.push_back(line ? std::make_unique<axes::xp200::DriveLine>(*line) : nullptr);
        const auto* axis = line ? nullptr : axis_on(config, config.serial[i]);
        if (axis == nullptr) continue;
        errors.push_back(
            {"serial.no_line", "serial." + config.serial[i].name,
             fmt::format("axis '{}' moves by drive '{}' on this line, and nothing was opened for it", axis->axis.name, axis->drive),
             "name its port in `device`, or write `simulated: true` under the axis; a program that builds the machine itself hands "
             "Machine::build a line for each entry of `serial`"});
    }
}

std::unique_ptr<axes::DrivePort> SerialDrives::drive_of(std::size_t axis) {
    const auto& config = body_.config;
    const auto& binding = config.axes[axis];
    if (binding.drive.empty() || binding.axis.simulated) return nullptr;
    for (std::size_t i = 0; i < config.serial.size(); ++i)
        for (const auto& entry : config.serial[i].drives) {
            if (entry.drive.name != binding.drive || !entry.drive.profile || !lines_[i]) continue;
            auto drive_config = entry.drive;
            drive_config.counts_per_turn = binding.axis.gearing.counts_per_revolution;
            drive_config.has_watchdog_output = !entry.watchdog_output.empty();
            auto drive = std::make_unique<axes::xp200::Xp200Drive>(std::move(drive_config), config.serial[i].settings);
            lines_[i]->add(*drive);
            Place place;
            place.drive = drive.get();
            place.axis = static_cast<std::uint16_t>(axis);
            place.station = entry.drive.station;
            place.watchdog = body_.io.find(IoDirection::output, entry.watchdog_output);
            drives_.push_back(place);
            return drive;
        }
    return nullptr;
}

void SerialDrives::step(Instant now) {
    if (body_.replayed) return;
    for (auto& line : lines_)
        if (line) line->step(now);
}

/// On while the line is heard and the drive is as configured. Whatever a program wrote there: the output has one writer. When the PC is dead
/// it falls by the terminal's own SM watchdog.
void SerialDrives::hold_watchdog_outputs() noexcept {
    for (const auto& place : drives_)
        if (place.watchdog >= 0) body_.io.outputs()[static_cast<std::size_t>(place.watchdog)] = place.drive->supervised(body_.now) ? 1 : 0;
}

/// An axis whose drive was never heard has nothing to lose, and no alarm of its own; nor has one without power whose drive falls silent.
void SerialDrives::watch() noexcept {
    const auto now = body_.now;
    for (auto& place : drives_) {
        const auto& sample = place.drive->newest();
        if (sample.online || place.online == Instant{}) place.online = now;
        const auto since_heard = now - std::max(sample.heard, place.online), since_online = now - place.online;
        if (since_heard >= silent_for)
            body_.raise(MachineAlarm::drive_silent, AlarmSource::axis, place.axis, place.station, to_seconds(silent_for));
        else if (since_online >= not_ready_for)
            body_.raise(MachineAlarm::drive_not_ready_on_line, AlarmSource::axis, place.axis, place.station, to_seconds(not_ready_for));
    }
}

std::string SerialDrives::line_of(std::size_t axis) const {
    const auto& config = body_.config;
    for (const auto& line : config.serial)
        for (const auto& entry : line.drives)
            if (axis < config.axes.size() && config.axes[axis].drive == entry.drive.name)
                return fmt::format(" of line '{}' ({}, {} baud, {})", line.name, line.device.empty() ? "simulated" : line.device,
                                   line.settings.baud, axes::xp200::format_text(line.settings));
    return {};
}

void SerialDrives::record() noexcept {
    for (std::size_t i = 0; i < drives_.size(); ++i) {
        const auto& sample = drives_[i].drive->newest();
        if (sample.revision == drives_[i].recorded) continue;
        drives_[i].recorded = sample.revision;
        record_sample(*body_.recorder, body_.now, static_cast<std::uint16_t>(i), sample);
    }
}

void SerialDrives::record_wishes() noexcept {
    for (std::size_t i = 0; i < drives_.size(); ++i) {
        const auto& wish = drives_[i].drive->wish();
        if (wish.sequence == drives_[i].wish) continue;
        drives_[i].wish = wish.sequence;
        record_wish(*body_.recorder, body_.now, static_cast<std::uint16_t>(i), wish);
    }
}

bool SerialDrives::replay(std::uint16_t drive, const axes::xp200::Sample& sample) noexcept {
    if (drive >= drives_.size()) return false;
    drives_[drive].drive->replay(sample);
    return true;
}

}  // namespace taktwerk::runtime
