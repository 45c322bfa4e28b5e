#include "ecat/bringup/scan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/bringup/presence.hpp"
#include "ecat/bringup/ring_line.hpp"
#include "ecat/bringup/sii_reader.hpp"
#include "ecat/bringup/slave_match.hpp"
#include "ecat/topology/topology.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration listening_time = std::chrono::milliseconds{25};  ///< a master that is there sends at least every 10 ms
constexpr std::uint64_t foreign_limit = 2;                          ///< frames: a single one may be a stray of an earlier run
constexpr int loop_rounds = 8;                                      ///< ports closed one behind the other

/// Whoever works with these slaves already is not disturbed: nothing was sent yet.
Script<Result<void>> listen_for_others(Bus& bus) {
    bus.progress = "listening for another master";
    co_await pause(2 * bus.config.cycle);  // what was on its way before
    const std::uint64_t before = bus.link.foreign_frames.load();
    co_await pause(std::max(listening_time, 2 * bus.config.cycle));
    const std::uint64_t heard = bus.link.foreign_frames.load() - before;
    if (heard < foreign_limit) co_return Result<void>{};
    co_return Error{"bus.foreign_master", "bus",
                    fmt::format("another EtherCAT master is sending on this cable ({} frames in {} ms): {}", heard,
                                listening_time / std::chrono::milliseconds{1}, sender_text(bus.link)),
                    "end that master, or connect the bus to this computer only; the slaves were left as they are"};
}

/// Ports that another master has closed open again where there is a link. A slave that appears may have closed ones of its own.
Script<void> open_ports(Bus& bus) {
    std::uint16_t count = 0;
    for (int round = 0; round < loop_rounds; ++round) {
        const Reply opened = co_await bus.port.bwr(reg::dl_control_loops, std::uint8_t{0});
        if (opened.lost || opened.wkc == count) co_return;
        count = opened.wkc;
    }
}

/// Of the very first frame nothing came back. What else is known is whether the port has a link.
Error nobody_answers(const Bus& bus) {
    if (!bus.link.line.link_up.load())
        return Error{"bus.no_link", "bus", "the network port has no link",
                     "check the cable and that the first slave has power; its IN port shows a light when it has"};
    return Error{"bus.no_frame", "bus", "no frame came back: no EtherCAT slave answers at the other end of the cable",
                 "check that the cable goes to the IN port of the first slave, and that it is an EtherCAT device with power"};
}

/// Every slave to INIT and its sync managers, FMMUs and clocks to rest, whatever they were before.
Script<Result<std::uint16_t>> reset_all(Bus& bus) {
    auto& port = bus.port;
    co_await open_ports(bus);
    const Reply first = co_await port.brd(reg::type, 1);
    if (first.lost) co_return nobody_answers(bus);
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

/// Controller and ports of one slave.
Script<FoundSlave> read_controller(DatagramPort& port, std::uint16_t position, std::uint16_t station, std::string subject) {
    FoundSlave found;
    found.position = position;
    found.station = station;
    const Reply info = co_await port.fprd(found.station, reg::type, 10);
    const Reply alias = co_await port.fprd(found.station, reg::station_alias, 2);
    const Reply dl = co_await port.fprd(found.station, reg::dl_status, 2);
    if (!info.ok() || !dl.ok()) {
        found.error = unanswered(subject, "its controller's description (0000h)", info.ok() ? dl : info);
        co_return found;
    }
    found.fmmus = static_cast<std::uint8_t>(info.data[reg::fmmu_count]);
    found.sync_managers = static_cast<std::uint8_t>(info.data[reg::sync_manager_count]);
    found.features = info.u16(reg::features);
    found.alias = alias.ok() ? alias.u16() : std::uint16_t{0};
    found.dl_status = dl.u16();
    co_return found;
}

Script<void> find_one(Bus& bus, std::uint16_t position, bool wants_id, FoundSlave& found) {
    const std::string subject = fmt::format("slave {}", position);
    const Reply written = co_await bus.port.apwr(position, reg::station_address, station_at(position));
    if (!written.ok()) {
        found.position = position;
        found.error = unanswered(subject, "its station address (0010h)", written);
        co_return;
    }
    found = co_await read_controller(bus.port, position, station_at(position), subject);
    if (found.error) co_return;
    Result<Sii> sii = co_await read_whole_sii(bus.port, found.station, subject);
    if (!sii) {
        found.error = sii.error();
        co_return;
    }
    found.sii = std::move(*sii);
    found.identity = found.sii.identity;
    found.mailbox = {found.sii.mailbox_out.start, found.sii.mailbox_out.size, found.sii.mailbox_in.start, found.sii.mailbox_in.size};
    if (wants_id) found.device_id = co_await read_device_id(bus.port, found.station, id_register(found.sii));
}

/// What a technician wants to know of an EEPROM that was read all the same.
void note_defects(Bus& bus) {
    for (const auto& slave : bus.found)
        for (const auto defect : slave.sii.defects)
            if (defect != SiiDefect::empty) bus.remember(fmt::format("slave {}: {}", slave.position, text(defect)));
}

/// Its position is not its place in the file: named as the configured slave that it is, where there is but one of its kind.
Error known_by_kind(const Bus& bus, Error error) {
    const auto& there = bus.found.back();
    const SlaveConfig* only = nullptr;
    std::size_t fitting = 0;
    for (const auto& wanted : bus.config.slaves)
        if (check_identity({}, wanted, there.identity)) only = &wanted, ++fitting;
    error.subject = fitting == 1 ? fmt::format("slave '{}' ({})", only->name, only->device->name)
                                 : fmt::format("slave {} ({})", there.position, found_text(there));
    return error;
}

/// The tree, from the ports as the slaves report them; asked again once where they contradict each other: a cable may just
/// have been plugged. Process data needs no tree, so the bring-up goes on without.
Script<Result<void>> find_topology(Bus& bus) {
    for (int attempt = 0; attempt < 2; ++attempt) {
        const bool again = attempt > 0;
        std::vector<std::uint16_t> dl_status;
        for (auto& slave : bus.found) {
            if (again) {
                const Reply reply = co_await bus.port.fprd(slave.station, reg::dl_status, 2);
                if (reply.ok()) slave.dl_status = reply.u16();
            }
            dl_status.push_back(slave.dl_status);
        }
        Result<Topology> tree = build_topology(dl_status);
        if (tree) {
            bus.topology = std::move(*tree);
            co_return Result<void>{};
        }
        if (again && tree.error().code == "bus.plugs_exchanged") co_return known_by_kind(bus, tree.error());
        if (again) bus.remember(tree.error().text());
    }
    bus.topology = {};
    co_return Result<void>{};
}

}  // namespace

Script<FoundSlave> read_slave(DatagramPort& port, std::uint16_t position, std::uint16_t station, std::string subject) {
    FoundSlave found = co_await read_controller(port, position, station, subject);
    if (found.error) co_return found;
    std::array<std::uint32_t, 6> values{};
    constexpr std::array<std::uint16_t, 6> words{sii_word::vendor, sii_word::product,     sii_word::revision,
                                                 sii_word::serial, sii_word::mailbox_out, sii_word::mailbox_in};
    for (std::size_t i = 0; i < words.size(); ++i) {
        const Result<std::uint32_t> value = co_await read_sii(port, found.station, words[i], subject);
        if (!value) {
            found.error = value.error();
            co_return found;
        }
        values[i] = *value;
    }
    found.identity = {values[0], values[1], values[2], values[3]};
    for (std::size_t i = 0; i < 2; ++i) {
        found.mailbox[2 * i] = static_cast<std::uint16_t>(values[4 + i] & 0xFFFFu);
        found.mailbox[2 * i + 1] = static_cast<std::uint16_t>(values[4 + i] >> 16);
    }
    co_return found;
}

std::uint16_t id_register(const Sii& sii) noexcept {
    return sii.general && (sii.general->flags & sii_flag::id_in_memory) != 0 ? sii.general->id_address : std::uint16_t{0};
}

Script<std::optional<std::uint16_t>> read_device_id(DatagramPort& port, std::uint16_t station, std::uint16_t address) {
    std::optional<std::uint16_t> id;
    if (address != 0) {
        const Reply there = co_await port.fprd(station, address, 2);
        if (there.ok() && there.u16() != 0) id = there.u16();
        co_return id;
    }
    const Reply state = co_await port.fprd(station, reg::al_status, 2);
    if (!state.ok()) co_return id;
    const auto present = static_cast<std::uint16_t>(state.u16() & al_state_mask);
    co_await port.fpwr(station, reg::al_control, static_cast<std::uint16_t>(present | al_control_request_id));
    const Instant started = co_await time();
    for (;;) {
        const Reply status = co_await port.fprd(station, reg::al_status, 6);
        // Controllers without a processor copy AL control to AL status, bit 5 too: their 0134h stays 0, which is no id.
        if (status.ok() && (status.u16() & al_status_id_valid) != 0 && status.u16(4) != 0) {
            id = status.u16(4);
            break;
        }
        const Instant now = co_await time();
        if (now - started >= device_id_timeout) break;
        co_await pause(std::chrono::milliseconds{1});
    }
    co_await port.fpwr(station, reg::al_control, present);
    co_return id;
}

Script<Result<void>> scan(Bus& bus) {
    const Result<void> alone = co_await listen_for_others(bus);
    if (!alone) co_return alone;
    bus.progress = "counting slaves";
    const Result<std::uint16_t> count = co_await reset_all(bus);
    if (!count) co_return count.error();
    const Result<void> line = co_await make_line(bus, *count);
    if (!line) co_return line;
    bus.progress = fmt::format("reading the EEPROM of {} slaves", *count);
    bus.found.assign(*count, {});
    const bool wants_id =
        std::any_of(bus.config.slaves.begin(), bus.config.slaves.end(), [](const SlaveConfig& s) { return s.device_id.has_value(); });
    std::vector<Script<void>> scripts;
    for (std::uint16_t position = 0; position < *count; ++position)
        scripts.push_back(find_one(bus, position, wants_id, bus.found[position]));
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    note_defects(bus);
    const Result<void> tree = co_await find_topology(bus);
    if (!tree) co_return tree;
    const Result<std::size_t> guests = match(bus.config, bus.found, bus.slaves);
    if (!guests) co_return guests.error();
    bus.link.line.guests.store(static_cast<std::uint16_t>(*guests));
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat
