#include "ecat/bringup/scan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/bringup/sii_reader.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat {

namespace {

std::string identity_text(const Identity& id, bool revision) {
    std::string text = fmt::format("vendor {:08X}h product {:08X}h", id.vendor, id.product);
    if (revision) text += fmt::format(" revision {:08X}h", id.revision);
    return text;
}

std::string found_text(const FoundSlave& slave) {
    return slave.error ? std::string{"not readable"}
                       : identity_text(slave.identity, true) + (slave.alias != 0 ? fmt::format(" alias {}", slave.alias) : "");
}

/// Every slave to INIT and its sync managers, FMMUs and clocks to rest, whatever they were before.
Script<Result<std::uint16_t>> reset_all(Bus& bus) {
    auto& port = bus.port;
    const Reply first = co_await port.brd(reg::type, 1);
    if (first.lost) co_return unanswered("bus", "the count of slaves", first);
    if (first.wkc == 0)
        co_return Error{"bus.empty", "bus", "frames come back, but no slave answered",
                        "check the power of the slaves and that the cable goes to the IN port of the first"};
    const std::uint16_t count = first.wkc;

    constexpr auto init = static_cast<std::uint16_t>(static_cast<unsigned>(AlState::init) | al_control_acknowledge);
    co_await port.bwr(reg::dl_control_alias, std::uint8_t{0});
    co_await port.bwr(reg::al_control, init);
    const Instant started = co_await time();
    for (;;) {
        const Reply states = co_await port.brd(reg::al_status, 2);
        const Instant now = co_await time();
        const bool all_init = !states.lost && states.wkc == count && states.u16() == static_cast<std::uint16_t>(AlState::init);
        if (all_init || now - started > std::chrono::seconds{2}) break;  // who does not reach INIT is named at PREOP
        co_await pause(std::chrono::milliseconds{1});
    }
    co_await port.bwr(reg::dc_activation, std::uint8_t{0});
    co_await port.bwr(reg::dc_cyclic_control, std::uint8_t{0});
    co_await port.clear_all(reg::rx_errors, 8);
    co_await port.clear_all(reg::fmmu, 16 * Fmmu::size);
    co_await port.clear_all(reg::sync_manager, 16 * SyncManager::size);
    co_await port.bwr(reg::dc_system_offset, std::uint64_t{0});
    co_await port.bwr(reg::dc_system_delay, std::uint32_t{0});
    co_await port.bwr(reg::dc_speed_start, std::uint16_t{0x1000});  // restarts the drift control
    co_await port.bwr(reg::dc_difference_filter, std::uint16_t{0x0C00});
    co_await port.bwr(reg::eeprom_configuration, std::uint8_t{2});  // take the EEPROM from an application that hangs
    co_await port.bwr(reg::eeprom_configuration, std::uint8_t{0});

    // Counted again: a slave may have joined meanwhile, and all of them answer after the reset.
    const Reply again = co_await port.brd(reg::type, 1);
    if (again.lost) co_return unanswered("bus", "the count of slaves", again);
    co_return again.wkc;
}

Script<void> find_one(Bus& bus, std::uint16_t position, FoundSlave& found) {
    const std::string subject = fmt::format("slave {}", position);
    const Reply written = co_await bus.port.apwr(position, reg::station_address, station_at(position));
    if (!written.ok()) {
        found.position = position;
        found.error = unanswered(subject, "its station address (0010h)", written);
        co_return;
    }
    found = co_await read_slave(bus.port, position, subject);
}

}  // namespace

Script<FoundSlave> read_slave(DatagramPort& port, std::uint16_t position, std::string subject) {
    FoundSlave found;
    found.position = position;
    found.station = station_at(position);
    const Reply info = co_await port.fprd(found.station, reg::type, 10);
    const Reply dl = co_await port.fprd(found.station, reg::dl_status, 2);
    if (!info.ok() || !dl.ok()) {
        found.error = unanswered(subject, "its controller's description (0000h)", info.ok() ? dl : info);
        co_return found;
    }
    found.fmmus = static_cast<std::uint8_t>(info.data[reg::fmmu_count]);
    found.sync_managers = static_cast<std::uint8_t>(info.data[reg::sync_manager_count]);
    found.features = info.u16(reg::features);
    found.dl_status = dl.u16();

    std::array<std::uint32_t, 7> values{};
    constexpr std::array<std::uint16_t, 7> words{sii_word::alias,  sii_word::vendor,      sii_word::product,   sii_word::revision,
                                                 sii_word::serial, sii_word::mailbox_out, sii_word::mailbox_in};
    for (std::size_t i = 0; i < words.size(); ++i) {
        const Result<std::uint32_t> value = co_await read_sii(port, found.station, words[i], subject);
        if (!value) {
            found.error = value.error();
            co_return found;
        }
        values[i] = *value;
    }
    found.alias = static_cast<std::uint16_t>(values[0] & 0xFFFFu);
    found.identity = {values[1], values[2], values[3], values[4]};
    for (std::size_t i = 0; i < 2; ++i) {
        found.mailbox[2 * i] = static_cast<std::uint16_t>(values[5 + i] & 0xFFFFu);
        found.mailbox[2 * i + 1] = static_cast<std::uint16_t>(values[5 + i] >> 16);
    }
    co_return found;
}

Result<void> check_identity(const std::string& subject, const DeviceDescription& device, const Identity& found) {
    const auto fits = [&](const Identity& wanted) {
        return wanted.vendor == found.vendor && wanted.product == found.product &&
               (!device.revision_exact || wanted.revision == found.revision);
    };
    if (fits(device.identity) || std::any_of(device.also_accepted.begin(), device.also_accepted.end(), fits)) return {};
    std::string expected = identity_text(device.identity, device.revision_exact);
    for (const auto& other : device.also_accepted) expected += " or " + identity_text(other, device.revision_exact);
    return Error{"bus.wrong_identity", subject, fmt::format("expected {}, found {}", expected, identity_text(found, true)),
                 "check the order of the slaves on the cable, or set the device of this slave in the configuration to what is there"};
}

Result<void> match(const BusConfig& config, const std::vector<FoundSlave>& found, std::vector<std::unique_ptr<BusSlave>>& slaves) {
    slaves.clear();
    std::vector<bool> used(found.size(), false);
    for (const auto& wanted : config.slaves) {
        const auto it = std::find_if(found.begin(), found.end(), [&](const FoundSlave& f) {
            return wanted.position ? f.position == *wanted.position : f.alias == *wanted.alias && !f.error;
        });
        if (it == found.end()) {
            const std::string where =
                wanted.position ? fmt::format("position {}", *wanted.position) : fmt::format("alias {}", *wanted.alias);
            const std::string last =
                found.empty() ? std::string{"the master"} : fmt::format("slave {} ({})", found.back().position, found_text(found.back()));
            return Error{
                "bus.missing_slave", fmt::format("slave '{}' ({})", wanted.name, wanted.device->name),
                fmt::format("there is no slave at {}: the bus has {} of {} configured slaves", where, found.size(), config.slaves.size()),
                wanted.position ? fmt::format("check power and cable behind {}", last)
                                : "set the alias in the drive and power-cycle it, or address it by position"};
        }
        auto slave = std::make_unique<BusSlave>();
        slave->config = &wanted;
        slave->index = slaves.size();
        slave->found = *it;
        slave->subject = fmt::format("slave {} '{}' ({})", it->position, wanted.name, wanted.device->name);
        if (it->error) {
            Error error = *it->error;
            error.subject = slave->subject;
            return error;
        }
        if (auto identity = check_identity(slave->subject, *wanted.device, it->identity); !identity) return identity;
        const auto at = static_cast<std::size_t>(it - found.begin());
        if (used[at])
            return Error{"bus.ambiguous", slave->subject, "two configured slaves stand for this one",
                         "correct position and alias in the configuration"};
        used[at] = true;
        slaves.push_back(std::move(slave));
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (used[i]) continue;
        return Error{"bus.unexpected_slave", fmt::format("slave {}", found[i].position),
                     fmt::format("is on the bus but not in the configuration: {}", found_text(found[i])),
                     "add it to the configuration or unplug it"};
    }
    return {};
}

Script<Result<void>> scan(Bus& bus) {
    bus.progress = "counting slaves";
    const Result<std::uint16_t> count = co_await reset_all(bus);
    if (!count) co_return count.error();
    bus.progress = fmt::format("reading the identity of {} slaves", *count);
    std::vector<FoundSlave> found(*count);
    std::vector<Script<void>> scripts;
    for (std::uint16_t position = 0; position < *count; ++position) scripts.push_back(find_one(bus, position, found[position]));
    co_await all(std::move(scripts));
    co_return match(bus.config, found, bus.slaves);
}

}  // namespace taktwerk::ecat
