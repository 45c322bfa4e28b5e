#include "ecat/firmware/slave_left.hpp"

#include <fmt/format.h>

#include "ecat/bringup/al_control.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::uint16_t no_valid_firmware = 0x0014;

}  // namespace

Script<Result<SlaveLeft>> look_at_left(Bus& bus, BusSlave& slave) {
    SlaveLeft left;
    const Result<std::uint16_t> status = co_await read_al_status(bus, slave);
    if (!status) co_return left;
    left.silent = false;
    left.state = al_state(*status);
    left.error = (*status & al_status_error) != 0;
    left.code = static_cast<std::uint16_t>(slave.link.al.load() >> 16);
    co_return left;
}

std::string left_text(const SlaveLeft& left, FirmwareLeft firmware) {
    const char* held = firmware == FirmwareLeft::untouched ? "its firmware is what it was"
                       : firmware == FirmwareLeft::broken
                           ? "it has part of the new firmware; whether the old one is still there is its maker's affair"
                           : "it has all of the new firmware";
    if (left.silent) return fmt::format("the slave does not answer; {}", held);
    std::string state = fmt::format("the slave is in {}", name(left.state));
    if (left.error) state += fmt::format(" and shows error {:04X}h {}", left.code, al_status_info(left.code).text);
    return fmt::format("{}; {}", state, held);
}

std::string way_back(const SlaveLeft& left, FirmwareLeft firmware) {
    if (left.error && left.code == no_valid_firmware)
        return "its boot loader found no valid firmware: give the command again, with a file that is made for it";
    if (left.silent) {
        const char* cure = "check cable and power, see with `taktwerk bus scan` what state it is in";
        if (firmware == FirmwareLeft::broken)
            return fmt::format("{}, and give the same command again: a boot loader takes the file from its beginning", cure);
        return firmware == FirmwareLeft::complete ? fmt::format("{}, and which version it has", cure)
                                                  : fmt::format("{}, and try again", cure);
    }
    if (firmware == FirmwareLeft::broken)
        return left.state == AlState::boot
                   ? "leave it switched on, and give the same command again: in BOOT it takes the file from its beginning"
                   : "give the same command again: it takes the file from its beginning";
    if (firmware == FirmwareLeft::complete) return "switch it off and on, then see with `taktwerk bus scan` which revision it has";
    return "mend what stopped it, and give the command again";
}

}  // namespace taktwerk::ecat
