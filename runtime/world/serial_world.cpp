#include "runtime/world/serial_world.hpp"

#include <algorithm>

#include "axes/drives/xp200/line_codes.hpp"
#include "axes/drives/xp200/registers.hpp"

namespace taktwerk::runtime {

namespace pr = axes::xp200::pr;

namespace {

constexpr int emergency_open = -15;  // EMG, on while the contact is open (XP200 manual 5.2, 5.4.2)

}  // namespace

void SerialWorld::build(const MachineConfig& config, const std::vector<axes::sim::PlantConfig>& plants, Instant start) {
    static const axes::DriveProfile plain;
    for (const auto& line_config : config.serial) {
        auto line = std::make_unique<Line>(line_config.name, line_config.settings);
        for (const auto& entry : line_config.drives) {
            axes::sim::PlantConfig plant;
            std::string axis;
            for (std::size_t i = 0; i < config.axes.size(); ++i) {
                if (config.axes[i].drive != entry.drive.name) continue;
                plant = plants[i];
                axis = config.axes[i].axis.name;
            }
            const auto& profile = entry.drive.profile ? *entry.drive.profile : plain;
            auto drive = std::make_unique<WiredDrive>(profile, plant);
            drive->axis = axis;
            drive->watchdog = entry.watchdog_output;
            drive->home_input = profile.input_bit_home;
            auto& parameters = drive->model.servo().parameters();
            // As its commissioner leaves it (9.2): on this line, in speed control, with what the machine file asks for.
            parameters.commission(pr::station, entry.drive.station);
            parameters.commission(pr::baud, axes::xp200::baud_code(line_config.settings.baud));
            parameters.commission(pr::format, axes::xp200::format_code(line_config.settings));
            parameters.commission(pr::control_mode, 1);
            parameters.commission(pr::encoder_lines, plant.counts_per_revolution / 4);
            for (const auto& parameter : entry.drive.parameters) {
                parameters.commission(parameter.number, parameter.value);
                if (parameter.number >= pr::input_function && parameter.number < pr::input_function + axes::xp200::input_count &&
                    parameter.value == emergency_open)
                    drive->stop_input = parameter.number - pr::input_function;
            }
            drive->model.servo().power_on(start);
            line->line.connect(*drive);
            line->drives.push_back(drive.get());
            drives_.push_back(std::move(drive));
        }
        cables_.push_back(std::make_unique<Cable>(*line));
        lines_.push_back(std::move(line));
    }
}

std::vector<modbus::SerialLine*> SerialWorld::lines() noexcept {
    std::vector<modbus::SerialLine*> out;
    for (auto& cable : cables_) out.push_back(cable.get());
    return out;
}

void SerialWorld::WiredDrive::advance(Instant now) {
    auto& servo = model.servo();
    Happening what;
    while (happenings.try_pop(what)) {
        using Kind = SimulationEvent::Kind;
        switch (what.kind) {
            case Kind::drive_fault: servo.raise(static_cast<std::uint16_t>(what.value)); break;
            case Kind::jam: servo.jam(what.value == 0); break;
            case Kind::main_power:
                if (what.value == 0) servo.power_off();
                else servo.power_on(now);
                break;
            default: break;
        }
    }
    // CCWL and CWL are normally closed (4.6): DI3 and DI4 as delivered.
    servo.inputs().contact(2, !servo.plant().positive_limit());
    servo.inputs().contact(3, !servo.plant().negative_limit());
    if (home_input >= 0) servo.inputs().contact(home_input, servo.plant().home_switch());
    if (stop_input >= 0) servo.inputs().contact(stop_input, watchdog_on.load(std::memory_order_relaxed));
    model.advance(now);
}

bool SerialWorld::happen(const SimulationEvent& event) noexcept {
    if (event.kind == SimulationEvent::Kind::serial_line) {
        for (auto& line : lines_)
            if (line->name == event.target) line->cut.store(event.value == 0, std::memory_order_relaxed);
        return true;
    }
    for (auto& drive : drives_)
        if (!drive->axis.empty() && drive->axis == event.target) return drive->happenings.try_push({event.kind, event.value});
    return false;
}

std::vector<modbus::Station*> SerialWorld::stations(std::string_view name) noexcept {
    std::vector<modbus::Station*> out;
    for (auto& line : lines_)
        if (line->name == name) out.assign(line->drives.begin(), line->drives.end());
    return out;
}

bool SerialWorld::is_cut(std::string_view name) const noexcept {
    return std::any_of(lines_.begin(), lines_.end(),
                       [&](const auto& line) { return line->name == name && line->cut.load(std::memory_order_relaxed); });
}

axes::sim::xp200::Drive* SerialWorld::drive(std::string_view axis) noexcept {
    for (auto& drive : drives_)
        if (drive->axis == axis) return &drive->model;
    return nullptr;
}

modbus::VirtualLine* SerialWorld::line(std::string_view name) noexcept {
    for (auto& line : lines_)
        if (line->name == name) return &line->line;
    return nullptr;
}

}  // namespace taktwerk::runtime
