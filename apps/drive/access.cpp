#include "apps/drive/access.hpp"

#include "apps/drive/in_machine.hpp"
#include "apps/drive/over_bus.hpp"
#include "apps/drive/over_line.hpp"
#include "apps/terminal/exit_code.hpp"
#include "axes/port/parameter_text.hpp"

namespace taktwerk::apps {

std::shared_ptr<DriveOptions> add_drive_options(CLI::App& sub) {
    auto options = std::make_shared<DriveOptions>();
    options->bus = add_bus_options(sub);
    sub.add_option("-s,--socket", options->socket, "running machine to ask: its name or socket; default, without a bus: the only one");
    sub.add_option("--profile", options->profile, "kind of drive; default: as the machine file or its identity says")->type_name("NAME");
    sub.add_option("--line", options->line, "serial port of a Modbus drive, such as /dev/ttyUSB0; DRIVE is its station there")
        ->type_name("DEVICE");
    sub.add_option("--baud", options->baud, "of --line (Pr182)")->capture_default_str();
    sub.add_option("--format", options->format, "of --line (Pr183)")->capture_default_str();
    return options;
}

void add_drive_choice(CLI::App& sub, DriveOptions& options) {
    sub.add_option("DRIVE", options.drive, "position or name on the bus, name on a serial line; of a running machine also an axis")
        ->required();
    sub.add_option("--axis", options.axis, "of a drive with several axes, from 1")->check(CLI::Range(1, 8));
}

void add_store_option(CLI::App& sub, DriveOptions& options) {
    sub.add_flag_callback(
        "--store", [&options] { options.storing = Storing::asked; },
        "into the drive's EEPROM, too; without it the values are lost at power off");
}

Result<std::int64_t> DriveAccess::read(const axes::DriveParameter& parameter) {
    const auto bytes = read_bytes(parameter);
    if (!bytes) return bytes.error();
    return axes::from_bytes(parameter, *bytes);
}

Result<void> DriveAccess::write(const axes::DriveParameter& parameter, std::int64_t raw, Storing storing) {
    return write_bytes(parameter, axes::to_bytes(parameter, raw), storing);
}

Result<void> DriveAccess::clear_turns() {
    return Error{"drive.needs_machine", subject(), "only a running machine clears the turns: it must know that the axis lost its reference",
                 "start the machine (taktwerk run FILE), `taktwerk disable AXIS`, and name no bus here"};
}

int with_drive(const DriveOptions& options, const std::function<int(DriveAccess&)>& work) {
    if (!options.socket.empty() && (!options.bus->nic.empty() || options.bus->simulate || !options.line.empty())) {
        fail(*options.bus, Error{"usage", "", "--socket asks a running machine, --nic, --line and --simulate speak to the drives directly",
                                 "give one of them"});
        return exit_usage;
    }
    if (options.through_machine()) return with_drive_in_machine(options, work);
    return is_on_line(options) ? with_drive_over_line(options, work) : with_drive_over_bus(options, work);
}

}  // namespace taktwerk::apps
