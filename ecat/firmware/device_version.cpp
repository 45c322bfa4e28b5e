#include "ecat/firmware/device_version.hpp"

#include <fmt/format.h>

#include "ecat/bringup/al_control.hpp"
#include "ecat/bringup/mailbox_setup.hpp"
#include "ecat/bringup/sii_reader.hpp"
#include "ecat/bringup/slave_objects.hpp"
#include "ecat/firmware/boot_state.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::uint16_t hardware_object = 0x1009, software_object = 0x100A, identity_object = 0x1018;

/// A string object, or nothing.
Script<std::string> read_words(Bus& bus, BusSlave& slave, std::uint16_t index) {
    const Result<std::vector<std::byte>> value = co_await sdo_upload(bus.port, slave.mailbox, index, 0);
    std::string words;
    if (!value) co_return words;
    for (const std::byte byte : *value) {
        const char c = static_cast<char>(byte);
        if (c == 0) break;
        words += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    while (!words.empty() && words.back() == ' ') words.pop_back();
    co_return words;
}

/// PREOP from wherever it is below SAFEOP, with its mailboxes set up.
Script<Result<void>> reach_objects(Bus& bus, BusSlave& slave) {
    const Result<void> down = co_await set_state(bus, slave, AlState::init);
    if (!down) co_return down;
    const Result<void> cleared = co_await clear_mailboxes(bus, slave);  // they may be those of BOOT
    if (!cleared) co_return cleared;
    co_return co_await enter_preop(bus, slave);
}

}  // namespace

Script<Result<DeviceVersion>> read_version(Bus& bus, BusSlave& slave) {
    DeviceVersion version;
    const Result<Sii> sii = co_await read_whole_sii(bus.port, slave.found.station, slave.subject);
    if (!sii) co_return sii.error();
    slave.found.sii = *sii;
    slave.found.identity = version.eeprom = sii->identity;
    slave.found.mailbox = {sii->mailbox_out.start, sii->mailbox_out.size, sii->mailbox_in.start, sii->mailbox_in.size};
    const Result<std::uint16_t> status = co_await read_al_status(bus, slave);
    if (!status) co_return status.error();
    if (!slave.has_coe() || al_state(*status) == AlState::boot) co_return version;
    const Result<void> reached = co_await reach_objects(bus, slave);
    if (!reached) {
        version.silence = reached.error();
        co_return version;
    }
    const Result<std::uint32_t> revision = co_await read_number(bus, slave, identity_object, 3);
    if (revision) version.revision = *revision;
    version.hardware = co_await read_words(bus, slave, hardware_object);
    version.software = co_await read_words(bus, slave, software_object);
    co_return version;
}

std::string text(const DeviceVersion& version) {
    std::string out = fmt::format("vendor {:08X}h product {:08X}h revision {:08X}h", version.eeprom.vendor, version.eeprom.product,
                                  version.eeprom.revision);
    if (version.revision && *version.revision != version.eeprom.revision) out += fmt::format(" (1018h: {:08X}h)", *version.revision);
    if (!version.hardware.empty()) out += fmt::format(", hardware '{}'", version.hardware);
    if (!version.software.empty()) out += fmt::format(", software '{}'", version.software);
    return out;
}

std::vector<std::string> changes(const DeviceVersion& before, const DeviceVersion& after) {
    std::vector<std::string> out;
    const auto number = [&](const char* what, std::uint32_t from, std::uint32_t to) {
        if (from != to) out.push_back(fmt::format("{} {:08X}h -> {:08X}h", what, from, to));
    };
    const auto words = [&](const char* what, const std::string& from, const std::string& to) {
        if (from != to) out.push_back(fmt::format("{} '{}' -> '{}'", what, from, to));
    };
    number("vendor", before.eeprom.vendor, after.eeprom.vendor);
    number("product", before.eeprom.product, after.eeprom.product);
    number("revision", before.eeprom.revision, after.eeprom.revision);
    number("serial number", before.eeprom.serial, after.eeprom.serial);
    if (before.revision && after.revision) number("object 1018h:03", *before.revision, *after.revision);
    words("hardware", before.hardware, after.hardware);
    words("software", before.software, after.software);
    return out;
}

}  // namespace taktwerk::ecat
