// taktwerk bus eoe: the Ethernet of slaves as a network interface of this computer.

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "apps/bus/bus.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/duration_option.hpp"
#include "apps/terminal/exit_code.hpp"
#include "ecat/diagnosis/mailbox_access.hpp"
#include "ecat/eoe/ethernet_bridge.hpp"
#include "ecat/eoe/ip_settings.hpp"

namespace taktwerk::apps {

namespace {

struct EoeOptions {
    std::shared_ptr<BusOptions> bus;
    std::vector<std::string> slaves, addresses;
    std::string tap;
    double duration_s = 0;
};

Result<void> offers_ethernet(const ecat::BusSlave& slave, const BusOptions& options) {
    const auto& sii = slave.found.sii;
    const bool silent = sii.mailbox_protocols == 0 && slave.has_mailbox();
    if (silent || options.force || (sii.mailbox_protocols & ecat::sii_protocol::eoe) != 0) return {};
    return Error{"eoe.not_offered", slave.subject, "its EEPROM says that it has no EoE: no Ethernet goes through its mailbox",
                 "check that this is the slave you mean; with --force it is tried all the same"};
}

/// Its mailbox is open, and it has its address.
Result<void> prepare(BusSession& session, ecat::BusSlave& slave, const EoeOptions& options,
                     const std::optional<ecat::IpAndSubnet>& address) {
    if (auto offered = offers_ethernet(slave, *options.bus); !offered) return offered;
    if (auto opened = session.probe().run(ecat::open_mailbox_for(session.bus(), slave, ecat::MailboxType::eoe)); !opened) return opened;
    if (!address) return {};
    ecat::EoeAddress settings;
    settings.ip = address->ip;
    settings.subnet = address->subnet;
    return session.probe().run(ecat::set_ip(session.probe().port(), slave.mailbox, settings));
}

Result<std::vector<std::optional<ecat::IpAndSubnet>>> addresses_of(const EoeOptions& options) {
    std::vector<std::optional<ecat::IpAndSubnet>> out(options.slaves.size());
    if (options.addresses.size() > options.slaves.size())
        return Error{"usage.number", "--ip", "there are more addresses than slaves", "give one for each slave, in their order"};
    for (std::size_t n = 0; n < options.addresses.size(); ++n) {
        out[n] = ecat::parse_ip_and_subnet(options.addresses[n]);
        if (!out[n]) return Error{"usage.number", "--ip", "'" + options.addresses[n] + "' is no address", "write it as 192.168.7.2/24"};
    }
    return out;
}

int carry_ethernet(BusSession& session, const EoeOptions& options, ecat::HostPort& host, const std::vector<ecat::BusSlave*>& slaves) {
    ecat::EthernetBridge bridge{host};
    for (auto* slave : slaves) bridge.add(slave->mailbox);
    fmt::print("{} carries the Ethernet of {}; give it an address of the same network: ip addr add ADDRESS/24 dev {}. Ctrl-C ends it\n",
               options.tap, count_text(slaves.size(), "slave"), options.tap);
    std::fflush(stdout);
    std::optional<Instant> until;
    if (options.duration_s > 0)
        until = session.now() + std::chrono::duration_cast<Duration>(std::chrono::duration<double>{options.duration_s});
    const auto carried = session.probe().run(bridge.carry(session.probe().port(), until));
    for (std::size_t n = 0; n < slaves.size(); ++n) {
        const auto& counts = bridge.link(n).counts();
        const auto lost = counts.dropped_full + counts.dropped_size + counts.dropped_lost + bridge.link(n).broken();
        fmt::print("{}: {} frames to it, {} from it, {} dropped\n", slaves[n]->subject, counts.sent, counts.received, lost);
    }
    if (carried || carried.error().code == "bus.interrupted") return exit_ok;
    return fail(*options.bus, carried.error());
}

int join_slaves(BusSession& session, const EoeOptions& options, const std::vector<std::optional<ecat::IpAndSubnet>>& addresses) {
    const auto& bus = *options.bus;
    if (session.simulated())
        return fail(bus, Error{"eoe.tap", options.tap, "in virtual time nobody outside can wait for an answer",
                               "play the slaves on a cable, with taktwerk sim, and name its interface: --nic"});
    const auto found = session.look();
    if (!found) return fail(bus, found.error());
    if (auto allowed = session.may_write(*found, "speaking to its mailboxes"); !allowed) return fail(bus, allowed.error());
    session.adopt(*found);
    std::vector<ecat::BusSlave*> slaves;
    for (std::size_t n = 0; n < options.slaves.size(); ++n) {
        const auto position = find_slave(*found, options.slaves[n]);
        if (!position) return fail(bus, position.error());
        const auto slave = slave_at(session, *found, *position);
        if (!slave) return fail(bus, slave.error());
        if (std::find(slaves.begin(), slaves.end(), *slave) != slaves.end())
            return fail(bus, Error{"usage.number", (*slave)->subject, "is named twice: it would get each frame twice",
                                   "name each slave once, with its address at the same place"});
        if (const auto ready = prepare(session, **slave, options, addresses[n]); !ready) return fail(bus, ready.error());
        slaves.push_back(*slave);
    }
    auto host = ecat::HostPort::open_tap(options.tap);
    if (!host) return fail(bus, host.error());
    return carry_ethernet(session, options, *host, slaves);
}

}  // namespace

void add_bus_eoe(CLI::App& bus, Action& action) {
    auto* sub = bus.add_subcommand("eoe", "the Ethernet of slaves (EoE) as a network interface of this computer, while the command lives");
    auto options = std::make_shared<EoeOptions>();
    options->bus = add_bus_options(*sub);
    sub->get_option("--force")->description("also where its EEPROM says that it has no EoE, or beside another master");
    sub->add_option("SLAVE", options->slaves, "positions or names; several are joined like the ports of a switch")->required();
    sub->add_option("--tap", options->tap, "name of the interface that is made")->required();
    sub->add_option("--ip", options->addresses, "what the slave is told of its address, 192.168.7.2/24; one for each slave, in their order")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    add_duration(*sub, "--for", options->duration_s, "end after it; default: at Ctrl-C");
    sub->callback([&action, options] {
        action = [options]() -> int {
            const auto addresses = addresses_of(*options);
            if (!addresses) return fail(*options->bus, addresses.error());
            return with_bus(*options->bus, [&](BusSession& session) { return join_slaves(session, *options, *addresses); });
        };
    });
}

}  // namespace taktwerk::apps
