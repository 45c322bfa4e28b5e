#include "runtime/check/serial_check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "axes/drives/xp200/line_codes.hpp"
#include "axes/drives/xp200/registers.hpp"
#include "axes/drives/xp200/settings.hpp"
#include "core/nearest_name.hpp"

namespace taktwerk::runtime {

namespace {

constexpr int highest_station = 247;  // XP200 manual 9.2

std::string listed(const std::vector<std::string>& names) {
    std::string out;
    for (const auto& name : names) out += (out.empty() ? "" : ", ") + name;
    return out.empty() ? "none" : out;
}

class SerialCheck {
public:
    SerialCheck(const MachineConfig& config, std::vector<Error>& errors) : config_(config), errors_(errors) {
        for (const auto& point : config.io)
            if (point.direction == IoDirection::output) outputs_.push_back(point.name);
    }

    void run() {
        if (!config_.serial.empty() && config_.bus.slaves.empty())
            add("serial.no_bus", "serial",
                "a machine with a serial line needs a bus too: its cycle runs on it, and so does what watches over the line",
                "add a digital terminal under `bus.slaves`, and wire one of its outputs to the drive as `watchdog_output`");
        for (const auto& line : config_.serial) {
            check_line(line);
            for (const auto& drive : line.drives) check_drive(line, drive);
        }
        for (const auto& binding : config_.axes)
            if (!binding.drive.empty()) check_axis(binding);
    }

private:
    void add(std::string code, std::string subject, std::string what, std::string remedy) {
        errors_.push_back({std::move(code), std::move(subject), std::move(what), std::move(remedy)});
    }

    void check_line(const SerialLineConfig& line) {
        const auto here = "serial." + line.name;
        if (!lines_.insert(line.name).second) add("config.duplicate_name", here, "the name is used twice", "rename one of them");
        if (!line.device.empty() && !devices_.insert(line.device).second)
            add("serial.device_taken", here + ".device", fmt::format("{} already belongs to another line", line.device),
                "name the other port");
        if (axes::xp200::baud_code(line.settings.baud) < 0)
            add("serial.baud", here + ".baud", fmt::format("{} baud is no rate of an XP200", line.settings.baud),
                "choose 4800, 9600, 19200 or 38400, as Pr182 says");
        std::set<int> stations;
        for (const auto& drive : line.drives)
            if (!stations.insert(drive.drive.station).second)
                add("serial.station_taken", fmt::format("{}.drives.{}.station", here, drive.drive.name),
                    fmt::format("station {} is there twice: both would answer at once", drive.drive.station),
                    "give each drive its own Pr181");
    }

    void check_drive(const SerialLineConfig& line, const SerialDriveConfig& entry) {
        const auto& drive = entry.drive;
        const auto here = fmt::format("serial.{}.drives.{}", line.name, drive.name);
        drives_.push_back(drive.name);
        if (!names_.insert(drive.name).second) add("config.duplicate_name", here, "the name is used twice", "rename one of them");
        if (drive.station < 1 || drive.station > highest_station)
            add("serial.station", here + ".station", "a station is 1 to 247, better 1 to 32", "use the number in Pr181");
        if (!drive.profile) add("serial.no_profile", here + ".profile", "there is no drive type", "name one, such as xp200");
        if (entry.watchdog_output.empty()) {
            if (entry.unsupervised_line != UnsupervisedLine::accepted)
                add("serial.unsupervised", here,
                    "when the line or the PC dies, this drive goes on at the speed it was given last; nothing here stops it then",
                    "wire an output of an EtherCAT terminal to its EMG input and name it in `watchdog_output`; if something else stops the "
                    "axis, write `unsupervised_line: accepted`");
        } else if (std::find(outputs_.begin(), outputs_.end(), entry.watchdog_output) == outputs_.end()) {
            const auto near = nearest_name(entry.watchdog_output, outputs_);
            add("serial.unknown_output", here + ".watchdog_output",
                fmt::format("there is no output '{}' (there is: {})", entry.watchdog_output, listed(outputs_)),
                near.empty() ? "declare it under `io.outputs`" : fmt::format("did you mean '{}'?", near));
        } else if (!watchdogs_.insert(entry.watchdog_output).second) {
            add("serial.output_taken", here + ".watchdog_output", "this output already watches another drive", "give each drive its own");
        }
        bool limits = false;
        for (const auto& parameter : drive.parameters) {
            limits = limits || parameter.number == axes::xp200::pr::limit_use;
            check_parameter(drive, parameter, here);
            check_against_line(line, drive, parameter, here);
        }
        if (!limits)
            add("serial.limit_policy", here + ".parameters",
                "nothing says whether the drive's limit switches count (Pr097; 33 ignores them)",
                "write `Pr097: 30` where they are wired, `Pr097: 33` where not");
    }

    void check_parameter(const axes::xp200::DriveConfig& drive, const axes::xp200::ParameterSetting& wanted, const std::string& here) {
        if (!drive.profile) return;
        const auto& rows = drive.profile->parameters;
        const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.address.index == wanted.number; });
        const auto subject = fmt::format("{}.parameters.Pr{:03}", here, wanted.number);
        if (row == rows.end())
            add("serial.unknown_parameter", subject, "the manual does not describe it, and reserved ones must not be written", "remove it");
        else if ((row->minimum && wanted.value < *row->minimum) || (row->maximum && wanted.value > *row->maximum))
            add("serial.parameter_range", subject,
                fmt::format("{} is outside {} to {}", wanted.value, row->minimum.value_or(0), row->maximum.value_or(0)),
                "correct the value");
        else if ((row->action || forces(wanted.number)) && wanted.value != 0)
            add("serial.parameter_owned", subject, fmt::format("{} is no setting: it would act each time the line comes up", row->name),
                "remove it; what it does belongs to whoever stands at the panel [5.4]");
        else if (axes::xp200::Settings::owns(wanted.number) && !forces(wanted.number))
            add("serial.parameter_owned", subject,
                fmt::format("{} is what the runtime commands the motor by, and writes itself", row->name),
                "remove it; the axis' `limits` say how fast and how hard");
    }

    /// What the drive needs to be reached at all: it counts after a restart, and then nobody hears it (9.2, 9.3).
    void check_against_line(const SerialLineConfig& line, const axes::xp200::DriveConfig& drive,
                            const axes::xp200::ParameterSetting& wanted, const std::string& here) {
        namespace pr = axes::xp200::pr;
        const auto& settings = line.settings;
        std::int64_t needed = 0;
        std::string key, meant;
        switch (wanted.number) {
            case pr::station:
                needed = drive.station, key = fmt::format("its `station` is {}", needed), meant = station_meant(wanted.value);
                break;
            case pr::baud:
                needed = axes::xp200::baud_code(settings.baud);
                key = fmt::format("the line's `baud` is {}", settings.baud);
                meant = meant_by(axes::xp200::baud_rates, wanted.value, " baud");
                break;
            case pr::format:
                needed = axes::xp200::format_code(settings);
                key = fmt::format("the line's `format` is {}", axes::xp200::format_text(settings));
                meant = meant_by(axes::xp200::character_formats, wanted.value, "");
                break;
            default: return;
        }
        if (needed < 0 || meant.empty() || needed == wanted.value) return;  // no code at all: said already
        add("serial.parameter_against_line", fmt::format("{}.parameters.Pr{:03}", here, wanted.number),
            fmt::format("{} {}, but {}: after its next restart nobody would hear the drive", wanted.value, meant, key),
            fmt::format("write {}, or leave it away: what the drive is set to at its panel has to be what stands at the line", needed));
    }

    static std::string station_meant(std::int64_t value) {
        if (value < -1 || value > highest_station) return {};
        return value == -1 ? "closes the port" : "is another station";
    }
    template <class Table>
    static std::string meant_by(const Table& table, std::int64_t code, std::string_view unit) {
        if (code < 0 || code >= static_cast<std::int64_t>(table.size())) return {};
        return fmt::format("means {}{}", table[static_cast<std::size_t>(code)], unit);
    }

    /// The motor on, or an input as if it were switched (5.4.1, 5.4.2); 0 is nothing.
    static bool forces(std::uint16_t number) noexcept {
        namespace pr = axes::xp200::pr;
        return number == pr::forced_enable || (number >= pr::force_1 && number <= pr::force_5);
    }

    void check_axis(const AxisBinding& binding) {
        const auto here = "axes." + binding.axis.name;
        if (!binding.slave.empty()) add("axis.two_drives", here + ".drive", "the axis has a `slave` and a `drive`", "keep one of them");
        if (std::find(drives_.begin(), drives_.end(), binding.drive) == drives_.end()) {
            const auto near = nearest_name(binding.drive, drives_);
            add("axis.unknown_drive", here + ".drive",
                fmt::format("there is no drive '{}' on a serial line (there is: {})", binding.drive, listed(drives_)),
                near.empty() ? "correct the name" : fmt::format("did you mean '{}'?", near));
        } else if (!taken_.insert(binding.drive).second) {
            add("axis.drive_taken", here + ".drive", fmt::format("drive '{}' already belongs to another axis", binding.drive),
                "give each axis its own");
        }
        const auto& axis = binding.axis;
        if (axis.control.mode != axes::ControlMode::velocity)
            add("axis.control", here + ".control", "a drive on a serial line takes no positions, only speeds",
                "add `control: {mode: velocity, kv: 3}`: the axis closes its position loop over them");
        else if (axis.control.kv > fastest_loop)
            add("axis.control", here + ".control.kv",
                fmt::format("a gain of {:g}/s is too much over a line that answers in tens of milliseconds", axis.control.kv),
                "use 2 to 5");
        const double turn = 1 / 60.0 * static_cast<double>(axis.gearing.counts_per_revolution) /
                            std::abs(axis.gearing.counts_per_unit());  // u/s of 1 r/min
        if (axis.control.kv > 0 && axis.windows.in_position < 0.5 * turn / axis.control.kv)
            add("axis.in_position", here + ".in_position.window",
                fmt::format("a window of {:g} {} cannot be reached: the drive takes whole r/min, and half of one at this kv is {:g} {}",
                            axis.windows.in_position, axis.unit, 0.5 * turn / axis.control.kv, axis.unit),
                "widen it, or raise control.kv");
        check_torque(binding, here);
        using Kind = axes::HomingKind;
        if (axis.homing.kind == Kind::drive || axis.homing.kind == Kind::absolute)
            add("axis.homing", here + ".homing.kind", "this drive has no homing of its own and no absolute encoder",
                "use home_switch, reference_pulse, limit_switch, block or set_here");
    }

    /// Pr004 = 5 lets MC_TorqueControl choose torque; EMG is its way out (axes/drives/xp200/schedule.hpp).
    void check_torque(const AxisBinding& binding, const std::string& here) {
        namespace pr = axes::xp200::pr;
        const auto* drive = find_drive(binding.drive);
        if (drive == nullptr || setting(*drive, pr::control_mode).value_or(1) != 5) return;
        if (setting(*drive, pr::emergency_mode) != 1)
            add("serial.torque_stop", here,
                "Pr004 is 5, torque control too, but nothing would brake the motor out of a torque: EMG cuts the current (Pr164 = 0)",
                "add `Pr164: 1` to the drive's parameters, or set Pr004 to 1");
        const auto& axis = binding.axis;
        const double ramp = static_cast<double>(std::max<std::int64_t>(setting(*drive, pr::stop_time).value_or(factory_stop_time), 1));
        const double turns = 1e6 / ramp / 60;  // per s2: ms for 1000 r/min
        const double braking = turns * static_cast<double>(axis.gearing.counts_per_revolution) / std::abs(axis.gearing.counts_per_unit());
        const double wanted = axis.limits.stop_deceleration > 0 ? axis.limits.stop_deceleration : axis.limits.deceleration;
        if (braking < wanted)
            add("serial.torque_ramp", here,
                fmt::format(
                    "out of torque control the drive brakes by Pr063 = {:g} ms, which are {:g} {}/s2: softer than the axis counts on "
                    "before its software limits, {:g}",
                    ramp, braking, axis.unit, wanted),
                fmt::format("set Pr063 to {:.0f} at most, or lower limits.stop_deceleration", std::floor(ramp * braking / wanted)));
    }

    [[nodiscard]] const axes::xp200::DriveConfig* find_drive(const std::string& name) const noexcept {
        for (const auto& line : config_.serial)
            for (const auto& entry : line.drives)
                if (entry.drive.name == name) return &entry.drive;
        return nullptr;
    }
    [[nodiscard]] static std::optional<std::int64_t> setting(const axes::xp200::DriveConfig& drive, std::uint16_t number) noexcept {
        for (const auto& parameter : drive.parameters)
            if (parameter.number == number) return parameter.value;
        return std::nullopt;
    }

    static constexpr std::int64_t factory_stop_time = 1000;  // Pr063 (5.4.1)
    static constexpr double fastest_loop = 8;                // 1/s

    const MachineConfig& config_;
    std::vector<Error>& errors_;
    std::vector<std::string> outputs_, drives_;
    std::set<std::string> lines_, devices_, names_, watchdogs_, taken_;
};

}  // namespace

void check_serial(const MachineConfig& config, std::vector<Error>& errors) { SerialCheck(config, errors).run(); }

}  // namespace taktwerk::runtime
