#include "ecat/bringup/slave_match.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "ecat/bringup/guests.hpp"
#include "ecat/bringup/known_pdos.hpp"
#include "ecat/bringup/shifted_slaves.hpp"

namespace taktwerk::ecat {

namespace {

std::string identity_text(const Identity& id, RevisionRule rule) {
    std::string text = fmt::format("vendor {:08X}h product {:08X}h", id.vendor, id.product);
    if (rule == RevisionRule::exact) text += fmt::format(" revision {:08X}h", id.revision);
    if (rule == RevisionRule::at_least) text += fmt::format(" revision {:08X}h or later", id.revision);
    return text;
}

bool fits(const Identity& wanted, RevisionRule rule, const Identity& found) {
    if (wanted.vendor != found.vendor || wanted.product != found.product) return false;
    return rule == RevisionRule::any ||
           (rule == RevisionRule::exact ? found.revision == wanted.revision : found.revision >= wanted.revision);
}

bool fits(const DeviceDescription& device, RevisionRule rule, const Identity& found) {
    return !device.stated.identity || fits(device.identity, rule, found) ||
           std::any_of(device.also_accepted.begin(), device.also_accepted.end(),
                       [&](const Identity& other) { return fits(other, rule, found); });
}

RevisionRule rule_of(const SlaveConfig& slave) { return slave.revision_rule.value_or(slave.device->revision_rule); }

Result<void> check(const std::string& subject, const DeviceDescription& device, RevisionRule rule, const Identity& found) {
    if (fits(device, rule, found)) return {};
    if (device.identity.vendor == 0 && device.identity.product == 0)
        return Error{
            "bus.wrong_identity", subject,
            fmt::format("nobody has told how a '{}' identifies itself, found {}", device.name, identity_text(found, RevisionRule::exact)),
            "compare with the drive's type plate, then write what was found under `identity:` of its drive file"};
    std::string expected = identity_text(device.identity, rule);
    for (const auto& other : device.also_accepted) expected += " or " + identity_text(other, rule);
    if (fits(device, RevisionRule::any, found))
        return Error{"bus.wrong_identity", subject,
                     fmt::format("it is the right device in another revision: expected {}, found {}", expected,
                                 identity_text(found, RevisionRule::exact)),
                     "check its firmware, or set `revision_rule: any` for this slave"};
    return Error{"bus.wrong_identity", subject, fmt::format("expected {}, found {}", expected, identity_text(found, RevisionRule::exact)),
                 "check the order of the slaves on the cable, or set the device of this slave in the configuration to what is there"};
}

/// How the configuration finds a slave.
struct Place {
    std::string text;  ///< "position 2", "alias 77"
    const char* code;  ///< of the error when two slaves answer to it
    std::function<bool(const FoundSlave&)> here;
};

Place place_of(const SlaveConfig& wanted) {
    if (wanted.alias)
        return {fmt::format("alias {}", *wanted.alias), "bus.duplicate_alias",
                [alias = *wanted.alias](const FoundSlave& f) { return f.alias == alias; }};
    if (wanted.device_id)
        return {fmt::format("device id {}", *wanted.device_id), "bus.duplicate_device_id",
                [id = *wanted.device_id](const FoundSlave& f) { return f.device_id == id; }};
    const std::uint16_t position = wanted.position.value_or(0);
    return {fmt::format("position {}", position), "bus.ambiguous", [position](const FoundSlave& f) { return f.position == position; }};
}

Error missing(const BusConfig& config, const std::vector<FoundSlave>& found, const SlaveConfig& wanted, const Place& place) {
    Error error{"bus.missing_slave", fmt::format("slave '{}' ({})", wanted.name, wanted.device->name),
                fmt::format("there is no slave at {}", place.text), ""};
    if (wanted.position) {
        error.what += fmt::format(": the bus has {} of {} configured slaves", found.size(), config.slaves.size());
        const std::string last =
            found.empty() ? std::string{"the master"} : fmt::format("slave {} ({})", found.back().position, found_text(found.back()));
        error.remedy = fmt::format("check power and cable behind {}", last);
        return error;
    }
    std::string there;
    for (const auto& f : found) {
        const auto number = wanted.alias ? (f.alias != 0 ? std::optional{f.alias} : std::nullopt) : f.device_id;
        if (number) there += fmt::format("{}{} at position {}", there.empty() ? "" : ", ", *number, f.position);
        if (wanted.alias && f.sii.alias == *wanted.alias && f.alias != *wanted.alias)
            error.what += fmt::format("; the EEPROM of slave {} holds this alias, it was not loaded yet", f.position);
    }
    error.what += fmt::format("; found: {}", there.empty() ? std::string{"none"} : there);
    error.remedy = wanted.alias ? "set the alias in the drive and power-cycle it, or address it by position"
                                : "set the id on its switches; a device without them is addressed by position or alias";
    return error;
}

/// Could each configured slave have a place of its own among those found, whatever the order? By augmenting paths.
std::optional<std::vector<std::size_t>> another_order(const BusConfig& config, const std::vector<FoundSlave>& found) {
    std::vector<std::optional<std::size_t>> taken_by(found.size());
    const std::function<bool(std::size_t, std::vector<bool>&)> place = [&](std::size_t slave, std::vector<bool>& tried) {
        const auto& wanted = config.slaves[slave];
        for (std::size_t f = 0; f < found.size(); ++f) {
            if (tried[f] || found[f].error || !fits(*wanted.device, rule_of(wanted), found[f].identity)) continue;
            tried[f] = true;
            if (!taken_by[f] || place(*taken_by[f], tried)) {
                taken_by[f] = slave;
                return true;
            }
        }
        return false;
    };
    for (std::size_t s = 0; s < config.slaves.size(); ++s) {
        std::vector<bool> tried(found.size(), false);
        if (!place(s, tried)) return std::nullopt;
    }
    std::vector<std::size_t> where(config.slaves.size());
    for (std::size_t f = 0; f < found.size(); ++f)
        if (taken_by[f]) where[*taken_by[f]] = f;
    return where;
}

/// Wrong only in their order? Names who would fit where.
void hint_at_order(const BusConfig& config, const std::vector<FoundSlave>& found, std::size_t wrong, std::size_t at, Error& error) {
    const auto& slave = config.slaves[wrong];
    for (std::size_t other = 0; other < config.slaves.size(); ++other) {
        const auto& peer = config.slaves[other];
        if (other == wrong || !slave.position || !peer.position || *peer.position >= found.size() || found[*peer.position].error) continue;
        if (fits(*peer.device, rule_of(peer), found[*peer.position].identity)) continue;  // who is in his place is nobody's swapped twin
        if (!fits(*slave.device, rule_of(slave), found[*peer.position].identity) || !fits(*peer.device, rule_of(peer), found[at].identity))
            continue;
        error.remedy = fmt::format("slaves '{}' and '{}' look swapped: exchange their cables, or their positions in the configuration",
                                   slave.name, peer.name);
        return;
    }
    if (fits(*slave.device, RevisionRule::any, found[at].identity)) return;  // the right device: its revision is the matter
    if (const auto where = another_order(config, found)) {
        std::string order;
        for (std::size_t s = 0; s < where->size(); ++s)
            order += fmt::format("{}'{}' at {}", order.empty() ? "" : ", ", config.slaves[s].name, (*where)[s]);
        error.remedy = fmt::format("all slaves are there, in another order: the cable fits {}", order);
    }
}

}  // namespace

bool recognises(const DeviceDescription& device, const Identity& found) {
    return device.stated.identity && fits(device, device.revision_rule, found);
}

std::string found_text(const FoundSlave& slave) {
    if (slave.error) return "not readable";
    if (slave.sii.has(SiiDefect::empty)) return "its EEPROM is empty";
    return identity_text(slave.identity, RevisionRule::exact) + (slave.alias != 0 ? fmt::format(" alias {}", slave.alias) : "");
}

Result<void> check_identity(const std::string& subject, const SlaveConfig& wanted, const Identity& found) {
    return check(subject, *wanted.device, rule_of(wanted), found);
}

Result<void> check_identity(const std::string& subject, const DeviceDescription& device, const Identity& found) {
    return check(subject, device, device.revision_rule, found);
}

namespace {

/// Those that are always there.
Result<void> match_residents(const BusConfig& config, const std::vector<FoundSlave>& found,
                             std::vector<std::unique_ptr<BusSlave>>& slaves) {
    if (auto shifted = shifted_slaves(config, found)) return std::move(*shifted);
    std::vector<bool> used(found.size(), false);
    for (const auto& wanted : config.slaves) {
        const Place place = place_of(wanted);
        const auto it = std::find_if(found.begin(), found.end(), place.here);
        if (it == found.end()) return missing(config, found, wanted, place);
        auto slave = std::make_unique<BusSlave>();
        slave->config = &wanted;
        slave->index = slaves.size();
        slave->found = *it;
        slave->subject = fmt::format("slave {} '{}' ({})", it->position, wanted.name, wanted.device->name);
        if (const auto twin = std::find_if(it + 1, found.end(), place.here); twin != found.end())
            return Error{place.code, slave->subject,
                         fmt::format("{} is set in two slaves, at positions {} and {}", place.text, it->position, twin->position),
                         "give one of them another one and power-cycle it"};
        if (it->error) {
            Error error = *it->error;
            error.subject = slave->subject;
            return error;
        }
        const auto at = static_cast<std::size_t>(it - found.begin());
        if (it->sii.has(SiiDefect::empty))
            return Error{"bus.wrong_identity", slave->subject, "its EEPROM is empty: it does not say who it is",
                         "write the vendor's EEPROM image to it"};
        if (auto identity = check_identity(slave->subject, wanted, it->identity); !identity) {
            Error error = identity.error();
            hint_at_order(config, found, slave->index, at, error);
            return error;
        }
        if (used[at])
            return Error{"bus.ambiguous", slave->subject, "two configured slaves stand for this one",
                         "correct position and alias in the configuration"};
        used[at] = true;
        slaves.push_back(std::move(slave));
    }
    if (config.extra_slaves == ExtraSlaves::ignore) return {};
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (used[i]) continue;
        return Error{"bus.unexpected_slave", fmt::format("slave {}", found[i].position),
                     fmt::format("is on the bus but not in the configuration: {}", found_text(found[i])),
                     "add it to the configuration, unplug it, or set `extra_slaves: ignore`"};
    }
    return {};
}

/// Its process data is laid out as its description has it; who it is shows when it comes.
std::unique_ptr<BusSlave> away_until_it_joins(const SlaveConfig& config, std::size_t index) {
    auto slave = std::make_unique<BusSlave>();
    slave->config = &config;
    slave->index = index;
    slave->subject = fmt::format("slave '{}' ({}) of group '{}'", config.name, config.device->name, config.hot_connect);
    slave->found.position = not_on_the_cable;
    slave->found.station = static_cast<std::uint16_t>(first_guest_station + index);
    slave->found.fmmus = config.device->fmmus;
    slave->found.sync_managers = config.device->sync_manager_count;
    auto known = known_pdos(config);
    slave->rx = std::move(known.rx);
    slave->tx = std::move(known.tx);
    slave->link.attendance.store(Attendance::away);
    return slave;
}

}  // namespace

Result<std::size_t> match(const BusConfig& config, const std::vector<FoundSlave>& found, std::vector<std::unique_ptr<BusSlave>>& slaves) {
    slaves.clear();
    const WithoutGuests rest = without_guests(config, found);
    std::vector<std::unique_ptr<BusSlave>> matched;
    if (const auto done = match_residents(rest.config, rest.found, matched); !done) {
        slaves = std::move(matched);  // as far as it went
        return done.error();
    }
    std::size_t next = 0;
    for (std::size_t i = 0; i < config.slaves.size(); ++i) {
        if (config.slaves[i].guest()) {
            slaves.push_back(away_until_it_joins(config.slaves[i], i));
            continue;
        }
        slaves.push_back(std::move(matched[next++]));
        slaves.back()->config = &config.slaves[i];
        slaves.back()->index = i;
        slaves.back()->found.position = rest.place[slaves.back()->found.position];
    }
    return found.size() - rest.found.size();
}

}  // namespace taktwerk::ecat
