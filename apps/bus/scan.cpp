// taktwerk bus scan: the tree of slaves, each with what it says of itself.

#include <cstdio>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "apps/bus/bus.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "apps/terminal/terminal_text.hpp"

namespace taktwerk::apps {

namespace {

using ecat::Survey;
using ecat::SurveyedSlave;

/// How many branches a slave is away from the line that starts at the master: the last exit goes straight on.
std::vector<std::size_t> branch_levels(const Survey& survey) {
    std::vector<std::size_t> levels(survey.slaves.size(), 0);
    if (!survey.topology) return levels;
    const auto& places = survey.topology->slaves;
    for (std::size_t i = 1; i < places.size(); ++i) {
        if (!places[i].parent) continue;
        const auto exits = places[*places[i].parent].exits();
        levels[i] = levels[*places[i].parent] + (exits.empty() || exits.back() == places[i].parent_port ? 0u : 1u);
    }
    return levels;
}

std::string name_of(const SurveyedSlave& slave) {
    if (!slave.device_name.empty()) return slave.device_name;
    if (!slave.order_name.empty()) return slave.order_name;
    return slave.found.error ? "not readable" : slave.expected.empty() ? "unnamed device" : slave.expected;
}

std::string ports_text(const Survey& survey, std::size_t position) {
    std::string text;
    const auto& slave = survey.slaves[position];
    for (unsigned p = 0; p < ecat::ports_per_slave; ++p) {
        const auto& port = slave.ports[p];
        const bool there = port.kind == ecat::PortKind::ebus || port.kind == ecat::PortKind::mii;
        if (!port.link && !port.open) {
            if (there && !port.counters.clean()) text += fmt::format("{}{} no link", text.empty() ? "" : ", ", p);
            continue;
        }
        const bool entry = survey.topology && survey.topology->slaves[position].entry_port == p;
        std::string other = ecat::neighbour(survey, position, p);
        other =
            other.empty() ? (port.open ? "open" : "link, but closed by a master (a bring-up opens it)") : (entry ? "from " : "to ") + other;
        text += fmt::format("{}{}{} {}", text.empty() ? "" : ", ", p, there ? " " + std::string{ecat::name(port.kind)} : "", other);
        if (!port.counters.clean()) text += " (errors)";
    }
    return text;
}

std::string abilities(const SurveyedSlave& slave) {
    std::string text = slave.dc() ? ((slave.found.features & ecat::feature::dc_64bit) != 0 ? "clock 64 bit" : "clock 32 bit") : "no clock";
    if (!slave.has_mailbox()) return text + ", no mailbox";
    text += fmt::format(", mailbox {}/{} bytes", slave.found.mailbox[1], slave.found.mailbox[3]);
    if (const auto protocols = slave.protocols(); !protocols.empty()) text += ": " + protocols;
    return text;
}

/// What the vendor calls it, from which file, and whether that is of the slave's own revision.
std::string vendor_text(const ecat::esi::EsiKnown& known, std::uint32_t revision) {
    const auto& heading = known.heading;
    auto text = fmt::format("{}{}{} ({})", heading.type, heading.name.empty() ? "" : ": ", heading.name, known.file);
    if (heading.identity.revision != revision) text += fmt::format(", described for revision {:08X}h", heading.identity.revision);
    return text;
}

Json port_json(const Survey& survey, std::size_t position, unsigned p) {
    const auto& port = survey.slaves[position].ports[p];
    Json json{{"port", p},
              {"kind", ecat::name(port.kind)},
              {"link", port.link},
              {"open", port.open},
              {"invalid_frames", port.counters.invalid_frames},
              {"rx_errors", port.counters.rx_errors},
              {"forwarded_errors", port.counters.forwarded_errors},
              {"lost_links", port.counters.lost_links}};
    if (survey.topology) {
        const auto& place = survey.topology->slaves[position];
        if (p == place.entry_port) json["towards_master"] = true;
        if (place.child[p]) json["slave_behind"] = *place.child[p];
    }
    return json;
}

}  // namespace

std::string scan_text(const std::string& where, const Survey& survey, Colours colours, const ecat::esi::EsiFolder* vendors) {
    std::string out = toned(where, Tone::strong, colours) + ": " + count_text(survey.slaves.size(), "slave") +
                      (survey.ring.shape == ecat::RingShape::closed ? ", a closed ring"
                       : survey.ring.needs_mending()                ? ", a broken ring"
                                                                    : "") +
                      "\n\n";
    const auto levels = branch_levels(survey);
    for (std::size_t i = 0; i < survey.slaves.size(); ++i) {
        const auto& slave = survey.slaves[i];
        const auto& id = slave.found.identity;
        std::string bars;
        for (std::size_t level = 0; level < levels[i]; ++level) bars += "│  ";
        std::string branch = bars;
        const bool turns_off =
            i > 0 && survey.topology && survey.topology->slaves[i].parent && levels[i] > levels[*survey.topology->slaves[i].parent];
        if (turns_off) {
            branch.resize(branch.size() - std::string_view{"│  "}.size());
            branch += fmt::format("├{}─", survey.topology->slaves[i].parent_port);
        }
        std::string head = fmt::format("{:<2} {}", i, name_of(slave));
        if (!slave.name.empty()) head += fmt::format("  '{}' {}", slave.name, slave.expected);
        const Cell state = state_cell(slave.state, slave.al_error);
        const std::size_t room = 80 - columns(state.text) - columns(branch);
        out += branch + toned(left(head, room), Tone::strong, colours) + toned(state.text, state.tone, colours) + "\n";

        bool goes_on = false;  // anything later at this level
        for (std::size_t k = i + 1; k < levels.size() && levels[k] >= levels[i]; ++k) goes_on = goes_on || levels[k] == levels[i];
        const std::string line = bars + (goes_on ? "│  " : "   ");
        out += line + fmt::format("station {:04X}h, {}, {}\n", slave.found.station,
                                  slave.found.alias != 0 ? fmt::format("alias {}", slave.found.alias) : "no alias", abilities(slave));
        if (!slave.found.error)
            out += line + fmt::format("vendor {:08X}h product {:08X}h revision {:08X}h serial {}\n", id.vendor, id.product, id.revision,
                                      id.serial);
        if (slave.found.device_id) out += line + fmt::format("explicit device id {}\n", *slave.found.device_id);
        if (const auto* known = vendors != nullptr && !slave.found.error ? vendors->find(id) : nullptr)
            out += line + cut(vendor_text(*known, id.revision), 80 - columns(line)) + "\n";
        else if (vendors != nullptr && !slave.found.error) out += line + "no file describes it\n";
        if (const auto ports = ports_text(survey, i); !ports.empty()) out += line + "port " + ports + "\n";
        if (slave.ebus_left)
            out += line +
                   toned(fmt::format("E-bus: {} {} mA, {} mA left", slave.ebus_current.value_or(0) < 0 ? "supplies" : "takes",
                                     std::abs(slave.ebus_current.value_or(0)), *slave.ebus_left),
                         *slave.ebus_left < 0 ? Tone::bad : Tone::plain, colours) +
                   "\n";
        if (slave.al_error)
            out += line +
                   toned(fmt::format("AL status code {:04X}h {}", slave.al_code, ecat::al_status_info(slave.al_code).text), Tone::bad,
                         colours) +
                   "\n";
    }
    for (const auto& group : survey.absent_groups) out += fmt::format("\ngroup '{}' is not plugged in\n", group);
    return out + remarks_text(survey, colours);
}

Json scan_json(const Survey& survey, const ecat::esi::EsiFolder* vendors) {
    Json slaves = Json::array();
    for (std::size_t i = 0; i < survey.slaves.size(); ++i) {
        const auto& slave = survey.slaves[i];
        const auto& id = slave.found.identity;
        Json json{{"position", i},
                  {"station", slave.found.station},
                  {"alias", slave.found.alias},
                  {"device", slave.device_name},
                  {"order", slave.order_name},
                  {"vendor", id.vendor},
                  {"product", id.product},
                  {"revision", id.revision},
                  {"serial", id.serial},
                  {"state", ecat::name(slave.state)},
                  {"error", slave.al_error},
                  {"al_status_code", slave.al_code},
                  {"al_status_text", slave.al_error ? ecat::al_status_info(slave.al_code).text : ""},
                  {"dc", slave.dc()},
                  {"mailbox_out", slave.found.mailbox[1]},
                  {"mailbox_in", slave.found.mailbox[3]},
                  {"protocols", slave.protocols()},
                  {"sm_watchdogs", slave.sm_watchdogs}};
        if (slave.found.device_id) json["device_id"] = *slave.found.device_id;
        if (slave.ebus_current) json["ebus_current_ma"] = *slave.ebus_current;
        if (slave.ebus_left) json["ebus_left_ma"] = *slave.ebus_left;
        if (survey.topology && survey.topology->slaves[i].parent) json["parent"] = *survey.topology->slaves[i].parent;
        json["ports"] = Json::array();
        for (unsigned p = 0; p < ecat::ports_per_slave; ++p) json["ports"].push_back(port_json(survey, i, p));
        if (const auto* known = vendors != nullptr ? vendors->find(id) : nullptr)
            json["esi"] = {{"type", known->heading.type},
                           {"name", known->heading.name},
                           {"vendor", known->vendor},
                           {"revision", known->heading.identity.revision},
                           {"file", known->file}};
        if (!slave.name.empty()) json["name"] = slave.name;
        if (!slave.expected.empty()) json["expected"] = slave.expected;
        if (slave.mismatch) json["mismatch"] = error_json(*slave.mismatch);
        if (slave.found.error) json["unreadable"] = error_json(*slave.found.error);
        slaves.push_back(std::move(json));
    }
    Json remarks = Json::array();
    for (const auto& remark : survey.remarks) remarks.push_back(error_json(remark));
    return Json{{"slaves", std::move(slaves)},
                {"ring", ecat::name(survey.ring.shape)},
                {"absent_groups", survey.absent_groups},
                {"remarks", std::move(remarks)}};
}

namespace {

/// --esi DIR. Nothing and ok: it was not asked for.
Result<std::optional<ecat::esi::EsiFolder>> vendors_in(const std::string& folder) {
    if (folder.empty()) return std::optional<ecat::esi::EsiFolder>{};
    auto found = ecat::esi::EsiFolder::open(folder);
    if (!found) return found.error();
    for (const auto& damaged : found->damaged()) print_warning(damaged);
    return std::optional<ecat::esi::EsiFolder>(std::move(*found));
}

}  // namespace

void add_bus_scan(CLI::App& bus, Action& action) {
    auto* sub = bus.add_subcommand("scan", "the tree of slaves: identity, name, state, ports, abilities; changes nothing on a running bus");
    auto options = add_bus_options(*sub);
    auto folder = std::make_shared<std::string>();
    add_operational(*sub, *options);
    sub->add_option("--esi", *folder, "a folder of vendors' ESI files (XML), which say who foreign slaves are")->type_name("DIR");
    sub->callback([&action, options, folder] {
        action = [options, folder]() -> int {
            const auto vendors = vendors_in(*folder);
            if (!vendors) {
                fail(*options, vendors.error());
                return exit_bad_file;
            }
            const auto* known = *vendors ? &**vendors : nullptr;
            return with_bus(*options, [&](BusSession& session) {
                Result<ecat::Survey> found = session.look();
                if (found && options->operational) {
                    if (auto up = session.bring_up(*found); !up) return fail(*options, up.error());
                    found = session.look();
                }
                if (!found) return fail(*options, found.error());
                if (options->json) print_json(scan_json(*found, known));
                else fmt::print("{}", scan_text(session.where(), *found, colours_of_output(), known));
                return static_cast<int>(has_problems(*found) ? exit_bus : exit_ok);
            });
        };
    });
}

}  // namespace taktwerk::apps
