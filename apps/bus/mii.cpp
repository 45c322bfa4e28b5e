// taktwerk bus mii SLAVE [PORT]: what the Ethernet PHYs at a slave's ports say of their links.

#include <algorithm>

#include <fmt/format.h>

#include "apps/bus/bus.hpp"
#include "apps/terminal/exit_code.hpp"
#include "ecat/diagnosis/phy_report.hpp"

namespace taktwerk::apps {

namespace {

struct MiiOptions {
    std::shared_ptr<BusOptions> bus;
    std::string slave;
    std::optional<unsigned> port;
};

std::string maker_text(const ecat::PhyRegisters& phy) {
    const auto maker = ecat::phy_maker(ecat::phy_maker_code(phy));
    return fmt::format("{:04X}h {:04X}h{}{}", phy.id1, phy.id2, maker.empty() ? "" : " ", maker);
}

Json phys_json(const ecat::Survey& survey, std::size_t position, const std::vector<ecat::PhyReport>& reports) {
    Json ports = Json::array();
    for (const auto& report : reports) {
        Json one{{"port", report.port}, {"address", report.address}};
        if (report.trouble) one["error"] = error_json(*report.trouble);
        if (report.phy) {
            const auto link = report.link();
            one["link"] = link.up;
            if (link.up) one["megabits"] = link.megabits, one["full_duplex"] = link.full_duplex;
            one["auto_negotiation"] = link.negotiates;
            one["agreed"] = link.agreed;
            one["id"] = {report.phy->id1, report.phy->id2};
            one["maker"] = ecat::phy_maker(ecat::phy_maker_code(*report.phy));
            one["finding"] = ecat::phy_finding(report);
        }
        ports.push_back(std::move(one));
    }
    return Json{{"slave", survey.subject(position)}, {"position", position}, {"ports", std::move(ports)}};
}

int show_phys(BusSession& session, const MiiOptions& options) {
    const auto found = session.look();
    if (!found) return fail(*options.bus, found.error());
    const auto position = find_slave(*found, options.slave);
    if (!position) return fail(*options.bus, position.error());
    const auto& slave = found->slaves[*position];
    if (slave.found.error) return fail(*options.bus, *slave.found.error);
    if (options.port && slave.ports.at(*options.port).kind != ecat::PortKind::mii)
        return fail(*options.bus,
                    Error{"bus.no_such_port", found->subject(*position),
                          fmt::format("port {} has no PHY: it is {}", *options.port, ecat::name(slave.ports[*options.port].kind)),
                          "`taktwerk bus scan` shows the kinds of the ports"});
    // Commands to the PHYs go through registers that another master may be using.
    if (const auto alone = session.may_write(*found, "asking its PHYs"); !alone) return fail(*options.bus, alone.error());
    const auto reports = session.probe().run(ecat::read_phys(session.probe().port(), slave, options.port, found->subject(*position)));
    if (!reports) return fail(*options.bus, reports.error());
    if (options.bus->json) print_json(phys_json(*found, *position, *reports));
    else fmt::print("{}", mii_text(found->subject(*position), *reports, colours_of_output()));
    const bool wrong = std::any_of(reports->begin(), reports->end(), [](const auto& report) { return !ecat::phy_finding(report).empty(); });
    return wrong ? exit_bus : exit_ok;
}

}  // namespace

std::string mii_text(const std::string& subject, const std::vector<ecat::PhyReport>& reports, Colours colours) {
    if (reports.empty()) return toned(subject, Tone::strong, colours) + ": none of its ports has a PHY\n";
    TextTable table{{{"port"}, {"link"}, {"speed"}, {"duplex"}, {"negotiation"}, {"PHY"}}};
    std::string findings;
    for (const auto& report : reports) {
        const auto port = std::to_string(report.port);
        if (!report.phy) {
            table.add({port, Cell{report.trouble ? report.trouble->what : "unknown", Tone::faint}});
            continue;
        }
        const auto link = report.link();
        const auto finding = ecat::phy_finding(report);
        const Tone tone = finding.empty() ? Tone::plain : Tone::bad;
        const std::string negotiation = !link.negotiates ? "off" : !link.up ? "on" : link.agreed ? "both ends agreed" : "this end only";
        if (!link.up) table.add({port, Cell{"none", Tone::faint}, "", "", negotiation, maker_text(*report.phy)});
        else
            table.add({port, Cell{"up", Tone::good},
                       Cell{link.megabits == 0 ? std::string{"?"} : fmt::format("{} Mbit", link.megabits), tone},
                       Cell{link.full_duplex ? "full" : "half", tone}, negotiation, maker_text(*report.phy)});
        if (!finding.empty()) findings += "\n" + wrapped(finding, 2) + "\n";
    }
    return toned(subject, Tone::strong, colours) + "\n\n" + table.text(colours, 2) + findings;
}

void add_bus_mii(CLI::App& bus, Action& action) {
    auto* sub = bus.add_subcommand("mii", "the Ethernet PHYs at a slave's ports: link, speed, duplex, auto-negotiation, maker");
    auto options = std::make_shared<MiiOptions>();
    options->bus = add_bus_options(*sub);
    sub->get_option("--force")->description("ask also while another master is on the cable");
    sub->add_option("SLAVE", options->slave, "position or name")->required();
    sub->add_option("PORT", options->port, "0 to 3; default: all with a PHY")->check(CLI::Range(0u, 3u));
    sub->callback([&action, options] {
        action = [options] { return with_bus(*options->bus, [&](BusSession& session) { return show_phys(session, *options); }); };
    });
}

}  // namespace taktwerk::apps
