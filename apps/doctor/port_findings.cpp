#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/doctor/findings.hpp"

namespace taktwerk::apps {
namespace {

/// The longest frame with preamble and gap, 1538 bytes, at 100 Mbit/s.
constexpr double longest_frame_us = 123;
/// IEEE 802.3, 78.5: how long a sleeping transmitter takes, in us.
constexpr double wake_of_fast_ethernet_us = 30, wake_of_gigabit_us = 16.5;

Finding of(Severity severity, std::string code, std::string found, std::string costs, std::string remedy) {
    return {std::move(code), severity, 0, std::move(found), std::move(costs), "", std::move(remedy)};
}

/// ethtool's words for a udev rule, so that the settings are there again when the interface comes. KERNEL, and the event of a renaming (`move`), since
/// NAME is given by a later rule (udev(7)).
HostChange kept(const std::string& interface, const std::string& what, const std::string& words) {
    return {HostChange::Kind::file, fmt::format("/etc/udev/rules.d/60-taktwerk-{}-{}.rules", interface, what),
            fmt::format("ACTION==\"add|move\", SUBSYSTEM==\"net\", KERNEL==\"{0}\", RUN+=\"/usr/sbin/ethtool {1}\"\n", interface, words)};
}

void link(std::vector<Finding>& out, const PortFacts& p) {
    if (!p.up)
        out.push_back(
            of(Severity::unfit, "port.down", p.name + " is switched off", "no frame leaves", fmt::format("ip link set {} up", p.name)));
    else if (!p.carrier)
        out.push_back(of(Severity::warning, "port.no_carrier", p.name + " has no link", "nothing was measured over it",
                         "plug the cable in; switch the first slave on"));
    else if (!p.bus.empty() && p.megabit > 0 && (p.megabit != 100 || p.duplex != "full"))
        out.push_back(of(Severity::warning, "port.link", fmt::format("the link of {} is {:.0f} Mbit/s {}", p.name, p.megabit, p.duplex),
                         "an EtherCAT slave has 100 Mbit/s full duplex: at the other end is somebody else (a switch, a PC)",
                         "plug the cable into the first slave"));
    if (!p.master.empty())
        out.push_back(of(Severity::unfit, "port.bridged", fmt::format("{} belongs to {} (a bridge or a bond)", p.name, p.master),
                         "frames go where that sends them", fmt::format("ip link set {} nomaster", p.name)));
    if (p.other_master)
        out.push_back(of(Severity::unfit, "port.other_master", "somebody has an EtherCAT socket on " + p.name,
                         "two masters on one bus: neither works; no round trips were measured",
                         "`ss -0 -p` names the process; end it before a machine is started here"));
}

void driver(std::vector<Finding>& out, const PortFacts& p, const Wanted& wanted) {
    const auto& e = p.ethernet;
    const auto which = e.driver.empty() ? std::string("of no known driver") : "driver " + e.driver;
    if (p.bus == "usb")
        out.push_back({"port.usb", severity_of(1000, wanted.cycle), 1000, fmt::format("{} ({}) is a USB adapter", p.name, which),
                       "frames wait for USB's schedule: 0.125 to 1 ms each way", "USB 2.0, micro-frame and frame",
                       "use a network card (PCIe, or on the board)"});
    else
        out.push_back(
            {"port.driver", Severity::good, 0, fmt::format("{} ({}){}", p.name, which, p.bus.empty() ? ", no hardware" : ""), "", "", ""});
    const auto wait = std::max(e.receive_us.value_or(0), e.adaptive_receive.value_or(false) ? 100u : 0u);
    if (wait > 0) {
        std::vector<HostChange> changes;
        std::string words;
        const auto set = [&](EthernetKnob knob, std::uint32_t value, const char* text) {
            if (const auto now = value_of(e, knob); !now || *now == value) return;
            changes.push_back({HostChange::Kind::ethernet, p.name, std::to_string(value), knob});
            words += fmt::format(" {} {}", name(knob), text);
        };
        set(EthernetKnob::adaptive_receive, 0, "off");
        set(EthernetKnob::receive_us, 0, "0");
        set(EthernetKnob::send_us, 0, "0");
        changes.push_back(kept(p.name, "coalescing", fmt::format("-C {}{}", p.name, words)));
        out.push_back({"port.coalescing", severity_of(wait, wanted.cycle), static_cast<double>(wait),
                       fmt::format("interrupts of {} wait {}", p.name,
                                   e.adaptive_receive.value_or(false) ? "as long as the driver likes (adaptive-rx)"
                                                                      : fmt::format("{} us for more frames", wait)),
                       fmt::format("answers are seen up to {} us late", wait),
                       "the driver's own figure (ethtool -c); of adaptive-rx: assumed", fmt::format("ethtool -C {}{}", p.name, words),
                       std::move(changes)});
    } else if (e.receive_us) out.push_back({"port.coalescing", Severity::good, 0, "interrupts of " + p.name + " come at once", "", "", ""});
    if (e.energy_efficient.value_or(false)) {
        const double wake = p.megabit >= 1000 ? wake_of_gigabit_us : wake_of_fast_ethernet_us;
        out.push_back({"port.eee",
                       severity_of(e.energy_efficient_now ? wake : 0, wanted.cycle),
                       e.energy_efficient_now ? wake : 0,
                       fmt::format("Energy-Efficient Ethernet is on at {}{}", p.name,
                                   e.energy_efficient_now ? "" : " (the other end does not take part now)"),
                       fmt::format("each frame wakes the link first: {:.1f} us", wake),
                       "IEEE 802.3, clause 78.5",
                       fmt::format("ethtool --set-eee {} eee off", p.name),
                       {{HostChange::Kind::ethernet, p.name, "0", EthernetKnob::energy_efficient},
                        kept(p.name, "eee", fmt::format("--set-eee {} eee off", p.name))}});
    }
}

void interrupts(std::vector<Finding>& out, const PortFacts& p, const Wanted& wanted) {
    if (wanted.cpu < 0 || p.irqs.empty() || p.irq_cpus.empty() || p.irq_cpus == std::vector<int>{wanted.cpu}) return;
    std::vector<HostChange> changes;
    std::string remedy;
    for (const int irq : p.irqs) {
        const auto path = fmt::format("/proc/irq/{}/smp_affinity_list", irq);
        changes.push_back({HostChange::Kind::knob, path, std::to_string(wanted.cpu)});
        remedy += fmt::format("{}echo {} > {}", remedy.empty() ? "" : "\n", wanted.cpu, path);
    }
    out.push_back({"port.interrupts", severity_of(10, wanted.cycle), 10,
                   fmt::format("interrupts {} of {} go to CPU {}, the cycle is on CPU {}", fmt::join(p.irqs, ", "), p.name,
                               fmt::join(p.irq_cpus, ", "), wanted.cpu),
                   "an answer is handled on another CPU: cold caches, some 10 us", "assumed", remedy, std::move(changes)});
}

void others(std::vector<Finding>& out, const PortFacts& p, const Wanted& wanted) {
    for (const auto& manager : p.managers) {
        std::vector<HostChange> changes;
        std::string remedy = fmt::format("end it for this interface: {} {}", manager, p.name), then;
        if (manager == "NetworkManager") {
            const auto path = fmt::format("/etc/NetworkManager/conf.d/60-taktwerk-{}.conf", p.name);
            const auto text = fmt::format("[keyfile]\nunmanaged-devices+=interface-name:{}\n", p.name);
            changes.push_back({HostChange::Kind::file, path, text});
            then = "systemctl reload NetworkManager";
            remedy = fmt::format("printf '[keyfile]\\nunmanaged-devices+=interface-name:{}\\n' > {}\nsystemctl reload NetworkManager",
                                 p.name, path);
        } else if (manager == "systemd-networkd") {
            const auto path = fmt::format("/etc/systemd/network/05-taktwerk-{}.network", p.name);
            changes.push_back({HostChange::Kind::file, path, fmt::format("[Match]\nName={}\n\n[Link]\nUnmanaged=yes\n", p.name)});
            then = "networkctl reload";
            remedy = fmt::format("printf '[Match]\\nName={}\\n\\n[Link]\\nUnmanaged=yes\\n' > {}\nnetworkctl reload", p.name, path);
        }
        out.push_back(
            {"port.managed", severity_of(longest_frame_us, wanted.cycle), longest_frame_us,
             fmt::format("{} configures {}", manager, p.name),
             "it sends DHCP and others between the frames of the bus (123 us each at most), and takes the link down when nobody answers",
             "1538 bytes at 100 Mbit/s", remedy, std::move(changes), then});
    }
    if (p.routed)
        out.push_back({"port.addressed", severity_of(longest_frame_us, wanted.cycle), longest_frame_us, p.name + " has an IP address",
                       "other programs send over it: 123 us of the cable for each long frame", "1538 bytes at 100 Mbit/s",
                       fmt::format("ip addr flush dev {}", p.name)});
    if (p.ipv6.value_or(false))
        out.push_back({"port.ipv6",
                       severity_of(10, wanted.cycle),
                       10,
                       "the kernel speaks IPv6 on " + p.name,
                       "it asks for routers and neighbours: short frames, 7 to 10 us each",
                       "RFC 4861; 90 bytes at 100 Mbit/s",
                       fmt::format("sysctl net/ipv6/conf/{}/disable_ipv6=1", p.name),
                       {{HostChange::Kind::knob, fmt::format("/proc/sys/net/ipv6/conf/{}/disable_ipv6", p.name), "1"},
                        {HostChange::Kind::file, fmt::format("/etc/sysctl.d/60-taktwerk-{}-ipv6.conf", p.name),
                         fmt::format("net/ipv6/conf/{}/disable_ipv6 = 1\n", p.name)}}});
    if (p.managers.empty() && !p.routed && p.master.empty() && !p.other_master)
        out.push_back({"port.alone", Severity::good, 0, "nobody else uses " + p.name, "", "", ""});
}

/// Where frames are not, or nobody can say from here what they meet.
Finding not_here(const PortFacts& p) {
    const auto go_there = fmt::format("ip netns exec NAME taktwerk doctor --nic {}", p.name);
    if (p.place == PortPlace::unseen)
        return of(Severity::warning, "port.unseen",
                  fmt::format("{} is in the network namespace of this process, and /sys shows another one", p.name),
                  "its link, driver, interrupts and who else uses it are not looked at; round trips are measured",
                  go_there + "      # has the /sys of its namespace");
    const bool alone = p.others && p.others->empty();
    const auto what =
        p.place == PortPlace::elsewhere
            ? fmt::format("{} is in another network namespace: /sys shows it, and no socket of this process can have it", p.name)
            : fmt::format("there is no network interface {}", p.name);
    if (alone)
        return of(Severity::unfit, "port.missing", what + "; that of this process has the loopback alone", "no bus",
                  fmt::format("{}      # where the port is, or bring it here:\nip link set {} netns NAME_OR_PID", go_there, p.name));
    return of(Severity::unfit, "port.missing", what, "no bus",
              p.others ? fmt::format("--nic with one of those that there are: {}", fmt::join(*p.others, ", "))
                       : std::string("`ip -br link` lists those that there are"));
}

}  // namespace

std::vector<Finding> port_findings(const PortFacts& facts, const Wanted& wanted) {
    std::vector<Finding> all;
    if (facts.place != PortPlace::here) {
        all.push_back(not_here(facts));
        return all;
    }
    link(all, facts);
    driver(all, facts, wanted);
    interrupts(all, facts, wanted);
    others(all, facts, wanted);
    return all;
}

}  // namespace taktwerk::apps
