#include "ecat/diagnosis/survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "ecat/bringup/guests.hpp"
#include "ecat/bringup/presence.hpp"
#include "ecat/bringup/scan.hpp"
#include "ecat/bringup/shifted_slaves.hpp"
#include "ecat/bringup/sii_reader.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

namespace {

std::uint8_t byte_at(const Reply& reply, std::size_t offset) noexcept {
    return offset < reply.data.size() ? static_cast<std::uint8_t>(reply.data[offset]) : std::uint8_t{0};
}

/// Address and AL state by position: what works on every bus.
Script<void> greet(DatagramPort& port, std::uint16_t position, SurveyedSlave& slave) {
    slave.found.position = position;
    const Reply address = co_await port.aprd(position, reg::station_address, 2);
    const Reply al = co_await port.aprd(position, reg::al_status, 6);
    if (!address.ok() || !al.ok()) {
        slave.found.error = unanswered(fmt::format("slave {}", position), "its station address (0010h)", address.ok() ? al : address);
        co_return;
    }
    slave.found.station = address.u16();
    slave.state = al_state(al.u16());
    slave.al_error = (al.u16() & al_status_error) != 0;
    slave.al_code = al.u16(4);
    const Reply owner = co_await port.aprd(position, reg::eeprom_configuration, 1);
    slave.eeprom_with_pdi = owner.ok() && (byte_at(owner, 0) & 1u) != 0;
}

/// Everything else, by station address.
Script<void> question(DatagramPort& port, SurveyedSlave& slave, SurveyMay may) {
    if (slave.found.error) co_return;
    const std::uint16_t position = slave.found.position, station = slave.found.station;
    if (may != SurveyMay::as_brought_up && station != station_at(position)) {
        slave.found.error = Error{"bus.foreign_address", fmt::format("slave {}", position),
                                  fmt::format("has the station address {:04X}h of another master and is {}", station, name(slave.state)),
                                  "end that master, then scan again"};
        co_return;
    }
    const std::string subject = fmt::format("slave {}", position);
    slave.found = co_await read_slave(port, position, station, subject);
    if (slave.found.error) co_return;
    const Reply description = co_await port.fprd(station, reg::port_descriptor, 1);
    for (unsigned p = 0; p < ports_per_slave; ++p) {
        auto& each = slave.ports[p];
        if (description.ok()) each.kind = static_cast<PortKind>((byte_at(description, 0) >> (2 * p)) & 3u);
        each.link = dl_signal(slave.found.dl_status, p);
        each.open = dl_port_open(slave.found.dl_status, p);
    }
    co_await read_counters(port, slave);
    Result<Sii> whole = co_await read_whole_sii(port, station, subject);
    if (!whole) co_return;  // who it is was read; what it can do beyond that stays unknown
    slave.found.sii = std::move(*whole);
    const auto& sii = slave.found.sii;
    if (!sii.general) co_return;
    slave.device_name = std::string{sii.string(sii.general->name)};
    slave.order_name = std::string{sii.string(sii.general->order)};
    slave.ebus_current = sii.general->ebus_current;
}

Script<void> ask_device_id(DatagramPort& port, SurveyedSlave& slave) {
    slave.found.device_id = co_await read_device_id(port, slave.found.station, id_register(slave.found.sii));
}

/// Those that say that they have one. Through AL control only while no master needs it.
Script<void> ask_device_ids(DatagramPort& port, Survey& survey, bool through_al_control) {
    std::vector<Script<void>> scripts;
    for (auto& slave : survey.slaves) {
        const auto& sii = slave.found.sii;
        const bool says = through_al_control && sii.general && (sii.general->flags & sii_flag::id_in_al_status) != 0;
        if (!slave.found.error && (says || id_register(sii) != 0)) scripts.push_back(ask_device_id(port, slave));
    }
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
}

/// E-bus: each coupler starts a budget, each terminal takes from it. Slaves stand in the order of the cable.
void sum_currents(Survey& survey) {
    std::optional<int> left;
    for (auto& slave : survey.slaves) {
        const bool on_ebus = std::any_of(slave.ports.begin(), slave.ports.end(), [](const auto& p) { return p.kind == PortKind::ebus; });
        const int current = slave.ebus_current.value_or(0);
        if (current < 0) left = -current;
        else if (!on_ebus) left.reset();
        else if (left) *left -= current;
        if (on_ebus || current < 0) slave.ebus_left = left;
    }
}

bool addresses_are_ours(const Survey& survey) {
    return std::all_of(survey.slaves.begin(), survey.slaves.end(), [](const SurveyedSlave& slave) {
        return slave.found.error || slave.found.station == station_at(slave.found.position);
    });
}

/// Says which configured one it is; whether it is the right device shows then.
void name_it(Survey& survey, SurveyedSlave& slave, const SlaveConfig& wanted) {
    slave.name = wanted.name;
    slave.expected = wanted.device->name;
    if (slave.found.error) return;
    const Result<void> same = check_identity(survey.subject(slave.found.position), wanted, slave.found.identity);
    if (!same) slave.mismatch = same.error();
}

/// Of groups: who is there by name, who is not plugged in, and what hinders those that are from joining.
void compare_groups(const BusConfig& config, const std::vector<FoundSlave>& found, Survey& survey) {
    const auto guest = guests_among(config, found);
    for (const auto& group : hot_connect_groups(config)) {
        const std::size_t head = group.slaves.front();
        const auto at = static_cast<std::size_t>(std::find(guest.begin(), guest.end(), head) - guest.begin());
        if (at == guest.size()) {
            survey.absent_groups.push_back(group.name);
            continue;
        }
        const auto subject = [&](std::size_t index) {
            return fmt::format("slave '{}' ({}) of group '{}'", config.slaves[index].name, config.slaves[index].device->name, group.name);
        };
        if (const auto twin = std::find(guest.begin() + static_cast<std::ptrdiff_t>(at) + 1, guest.end(), head); twin != guest.end())
            survey.remarks.push_back(Error{"bus.hot_connect", subject(head),
                                           fmt::format("its number is set in two slaves, at positions {} and {}", at, twin - guest.begin()),
                                           "unplug one of them, or give it another number and power-cycle it"});
        for (std::size_t n = 0; n < group.slaves.size(); ++n) {
            const std::size_t wanted = group.slaves[n];
            if (at + n < guest.size() && guest[at + n] == wanted) {
                name_it(survey, survey.slaves[at + n], config.slaves[wanted]);
                continue;
            }
            const std::string there = at + n < found.size() ? found_text(found[at + n]) : std::string{"nobody"};
            survey.remarks.push_back(Error{"bus.hot_connect", subject(wanted),
                                           fmt::format("{} of the {} slaves of its group are there: behind '{}' stands {}", n,
                                                       group.slaves.size(), config.slaves[group.slaves[n - 1]].name, there),
                                           "check its power and its cable inside the group"});
            break;
        }
    }
}

}  // namespace

std::string_view name(PortKind kind) noexcept {
    switch (kind) {
        case PortKind::ebus: return "E-bus";
        case PortKind::mii: return "MII";
        case PortKind::not_configured: return "not configured";
        case PortKind::none: break;
    }
    return "none";
}

bool SurveyedSlave::dc() const noexcept { return (found.features & feature::dc) != 0; }

std::string SurveyedSlave::protocols() const {
    constexpr std::array<std::pair<std::uint16_t, std::string_view>, 6> all{{{sii_protocol::coe, "CoE"},
                                                                             {sii_protocol::foe, "FoE"},
                                                                             {sii_protocol::eoe, "EoE"},
                                                                             {sii_protocol::soe, "SoE"},
                                                                             {sii_protocol::aoe, "AoE"},
                                                                             {sii_protocol::voe, "VoE"}}};
    std::string text;
    for (const auto& [bit, word] : all)
        if ((found.sii.mailbox_protocols & bit) != 0) text += (text.empty() ? "" : ", ") + std::string{word};
    return text;
}

std::string Survey::subject(std::size_t position) const {
    const std::string name = position < slaves.size() ? slaves[position].name : std::string{};
    return name.empty() ? fmt::format("slave {}", position) : fmt::format("slave {} '{}'", position, name);
}

std::optional<Error> ring_remark(const Survey& survey) {
    const RingState& ring = survey.ring;
    if (ring.shape == RingShape::exchanged)
        return Error{"bus.ring_exchanged", "bus", "the plugs of the two interfaces are exchanged: positions count from the second one",
                     "exchange the plugs, or `interface` and `interface2` in the machine file"};
    if (ring.shape == RingShape::one_way)
        return Error{"bus.ring_broken", "bus", "nothing comes back of what the second interface sends, although the ring is closed",
                     "check that interface: the next break would take slaves away"};
    if (!ring.broken() || survey.slaves.empty()) return std::nullopt;
    const std::size_t last = survey.slaves.size() - 1;
    const std::size_t behind = std::min<std::size_t>(ring.before_break, last);
    const std::string where = ring.shape == RingShape::first_silent    ? "between the first interface and " + survey.subject(0)
                              : ring.shape == RingShape::second_silent ? "between " + survey.subject(last) + " and the second interface"
                              : behind == 0                            ? "in front of " + survey.subject(0)
                                            : fmt::format("between {} and {}", survey.subject(behind - 1), survey.subject(behind));
    return Error{"bus.ring_broken", "bus", "the ring is broken " + where,
                 "mend the cable there: a second break would take slaves away, and the machine does not start with a broken ring"};
}

Script<bool> read_counters(DatagramPort& port, SurveyedSlave& slave) {
    const auto counters = co_await read_port_counters(port, slave.found.station);
    const Reply watchdog = co_await port.fprd(slave.found.station, reg::sm_watchdog_count, 1);
    if (watchdog.ok()) slave.sm_watchdogs = byte_at(watchdog, 0);
    if (!counters) co_return false;
    for (unsigned p = 0; p < ports_per_slave; ++p) slave.ports[p].counters = counters->ports[p];
    slave.processing_unit_errors = counters->processing_unit_errors;
    slave.pdi_errors = counters->pdi_errors;
    co_return true;
}

Script<Result<Survey>> survey(DatagramPort& port, SurveyMay may, const SeenRing* ring) {
    Survey result;
    const Reply count = co_await port.brd(reg::type, 1);
    if (count.lost) co_return unanswered("bus", "the count of slaves", count);
    if (count.wkc == 0)
        co_return Error{"bus.empty", "bus", "frames come back, but no slave answered",
                        "check the power of the slaves and that the cable goes to the IN port of the first"};
    result.slaves.resize(count.wkc);

    std::vector<Script<void>> scripts;
    for (std::uint16_t p = 0; p < count.wkc; ++p) scripts.push_back(greet(port, p, result.slaves[p]));
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    for (const auto& slave : result.slaves) result.highest_state = std::max(result.highest_state, slave.state);

    if (may == SurveyMay::give_addresses && result.highest_state < AlState::safeop) {
        co_await port.bwr(reg::eeprom_configuration, std::uint8_t{2});  // from an application that holds it
        co_await port.bwr(reg::eeprom_configuration, std::uint8_t{0});
        if (!addresses_are_ours(result))
            for (auto& slave : result.slaves) {
                const Reply written = co_await port.apwr(slave.found.position, reg::station_address, station_at(slave.found.position));
                if (written.ok()) slave.found.station = station_at(slave.found.position);
            }
    }

    std::vector<Script<void>> questions;
    for (auto& slave : result.slaves) questions.push_back(question(port, slave, may));
    co_await all(std::move(questions), DatagramPort::slaves_at_once);
    co_await ask_device_ids(port, result, may == SurveyMay::give_addresses && result.highest_state < AlState::safeop);

    if (ring != nullptr) result.ring = ring->load();
    std::vector<std::uint16_t> links;
    for (const auto& slave : result.slaves) links.push_back(slave.found.dl_status);
    const bool all_read =
        std::none_of(result.slaves.begin(), result.slaves.end(), [](const SurveyedSlave& s) { return s.found.error.has_value(); });
    if (all_read) {
        Result<Topology> tree =
            ring != nullptr ? build_ring_topology(links, reached_from_first(result.ring, links.size())) : build_topology(links);
        if (tree) result.topology = std::move(*tree);
        else result.remarks.push_back(tree.error());
    }
    sum_currents(result);
    co_return result;
}

Script<Result<void>> read_device_ids(DatagramPort& port, Survey& survey) {
    std::vector<Script<void>> scripts;
    for (auto& slave : survey.slaves)
        if (!slave.found.error) scripts.push_back(ask_device_id(port, slave));
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    co_return Result<void>{};
}

void compare_with(const BusConfig& config, Survey& survey) {
    std::vector<FoundSlave> all;
    for (const auto& slave : survey.slaves) all.push_back(slave.found);
    compare_groups(config, all, survey);
    const WithoutGuests cable = without_guests(config, all);
    if (auto shifted = shifted_slaves(cable.config, cable.found)) {
        survey.remarks.push_back(std::move(*shifted));  // who stands behind it is no wrong device
        return;
    }
    std::set<std::size_t> named;
    for (const auto& wanted : cable.config.slaves) {
        const auto at = std::find_if(cable.found.begin(), cable.found.end(), [&](const FoundSlave& there) {
            if (wanted.position) return there.position == *wanted.position;
            if (wanted.alias) return !there.error && there.alias == *wanted.alias;
            return wanted.device_id && there.device_id == wanted.device_id;
        });
        if (at == cable.found.end()) {
            const std::string where = wanted.position ? fmt::format("at position {}", *wanted.position)
                                      : wanted.alias  ? fmt::format("with alias {}", *wanted.alias)
                                                      : fmt::format("with device id {}", wanted.device_id.value_or(0));
            survey.remarks.push_back(Error{"bus.missing_slave", fmt::format("slave '{}' ({})", wanted.name, wanted.device->name),
                                           fmt::format("there is no slave {}: the cable has {}, configured are {}", where,
                                                       cable.found.size(), cable.config.slaves.size()),
                                           wanted.position ? fmt::format("check power and cable behind slave {}", survey.slaves.size() - 1)
                                                           : "set it in the slave and power-cycle it, or address it by position"});
            continue;
        }
        const std::size_t place = cable.place[static_cast<std::size_t>(at - cable.found.begin())];
        named.insert(place);
        name_it(survey, survey.slaves[place], wanted);
    }
    if (config.slaves.empty()) return;
    for (const std::size_t place : cable.place)
        if (!named.contains(place))
            survey.remarks.push_back(Error{"bus.unexpected_slave", fmt::format("slave {}", place),
                                           "is on the cable but not in the configuration",
                                           config.extra_slaves == ExtraSlaves::ignore ? "it stays as it is: extra slaves are ignored"
                                                                                      : "add it to the configuration or unplug it"});
}

}  // namespace taktwerk::ecat
