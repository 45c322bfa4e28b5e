#include "apps/doctor/port_facts.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

/// Lines of a file, each as its words.
std::vector<std::vector<std::string>> table(const HostFiles& files, std::string_view path) {
    std::vector<std::vector<std::string>> rows;
    const auto all = files.text(path).value_or("");
    for (std::size_t at = 0; at < all.size();) {
        const auto end = std::min(all.find('\n', at), all.size());
        rows.push_back(words_of(std::string_view(all).substr(at, end - at)));
        at = end + 1;
    }
    return rows;
}

bool has_line(const std::string& text, std::string_view line) {
    const auto at = ("\n" + text + "\n").find("\n" + std::string(line) + "\n");
    return at != std::string::npos;
}

/// Who has taken it upon himself to configure the interface: it brings addresses, DHCP, and takes the link down when it likes.
std::vector<std::string> managers(const HostFiles& files, const PortFacts& port) {
    std::vector<std::string> all;
    // NetworkManager's and systemd-networkd's own notes of each interface, by its index.
    if (const auto says = files.text(fmt::format("/run/NetworkManager/devices/{}", port.index)); says && has_line(*says, "managed=true"))
        all.emplace_back("NetworkManager");
    if (const auto says = files.text(fmt::format("/run/systemd/netif/links/{}", port.index));
        says && says->find("ADMIN_STATE=") != std::string::npos && !has_line(*says, "ADMIN_STATE=unmanaged"))
        all.emplace_back("systemd-networkd");
    for (const auto& process : files.names("/proc")) {
        if (process.empty() || process.find_first_not_of("0123456789") != std::string::npos) continue;
        const auto name = files.text("/proc/" + process + "/comm").value_or("");
        if (name != "dhclient" && name != "dhcpcd" && name != "udhcpc") continue;
        auto words = files.text("/proc/" + process + "/cmdline").value_or("");
        std::replace(words.begin(), words.end(), '\0', ' ');
        const auto each = words_of(words);
        if (std::find(each.begin(), each.end(), port.name) != each.end() || (name == "dhcpcd" && each.size() <= 1)) all.push_back(name);
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

std::vector<int> irqs(const HostFiles& files, const std::string& folder, const std::string& interface) {
    std::vector<int> all;
    for (const auto& number : files.names(folder + "/device/msi_irqs")) all.push_back(std::atoi(number.c_str()));
    if (!all.empty()) {  // of all that the device has, those of this port: they are named after it
        const auto has_name = [&](int irq) {
            for (const auto& action : files.names(fmt::format("/proc/irq/{}", irq)))
                if (action.find(interface) != std::string::npos) return true;
            return false;
        };
        auto named = all;
        std::erase_if(named, [&](int irq) { return !has_name(irq); });
        return named.empty() ? all : named;
    }
    for (const auto& row : table(files, "/proc/interrupts"))
        if (row.size() > 2 &&
            std::any_of(row.begin() + 1, row.end(), [&](const auto& w) { return w == interface || w == interface + ","; }))
            all.push_back(std::atoi(row.front().c_str()));
    return all;
}

void facts_of_one_that_is_here(PortFacts& p, const HostFiles& files, const EthernetPorts& ports) {
    const auto folder = "/sys/class/net/" + p.name;
    p.index = static_cast<int>(files.number(folder + "/ifindex").value_or(0));
    const auto flags = std::strtoul(files.text(folder + "/flags").value_or("0").c_str(), nullptr, 16);
    p.up = (flags & 1) != 0;  // IFF_UP
    p.carrier = files.number(folder + "/carrier").value_or(0) != 0;
    p.megabit = std::max(0.0, files.number(folder + "/speed").value_or(0));
    p.duplex = files.text(folder + "/duplex").value_or("");
    p.bus = files.link_name(folder + "/device/subsystem");
    p.master = files.link_name(folder + "/master");
    p.ethernet = ports.read(p.name);
    if (p.ethernet.driver.empty()) p.ethernet.driver = files.link_name(folder + "/device/driver");
    p.irqs = irqs(files, folder, p.name);
    for (const int irq : p.irqs)
        for (const int cpu : cpu_list(files.text(fmt::format("/proc/irq/{}/smp_affinity_list", irq)).value_or("")))
            if (std::find(p.irq_cpus.begin(), p.irq_cpus.end(), cpu) == p.irq_cpus.end()) p.irq_cpus.push_back(cpu);
    std::sort(p.irq_cpus.begin(), p.irq_cpus.end());
    for (const auto& row : table(files, "/proc/net/route")) p.routed = p.routed || (!row.empty() && row.front() == p.name);
    for (const auto& row : table(files, "/proc/net/if_inet6"))
        if (row.size() == 6 && row.back() == p.name) p.ipv6_addresses.push_back(row.front());
    if (const auto off = files.number("/proc/sys/net/ipv6/conf/" + p.name + "/disable_ipv6")) p.ipv6 = *off == 0;
    p.managers = managers(files, p);
    for (const auto& row : table(files, "/proc/net/packet"))  // sk RefCnt Type Proto Iface R Rmem User Inode
        p.other_master = p.other_master || (row.size() >= 5 && row[3] == "88a4" && std::atoi(row[4].c_str()) == p.index);
}

}  // namespace

PortFacts port_facts(const HostFiles& files, const EthernetPorts& ports, const std::string& interface) {
    PortFacts p;
    p.name = interface;
    const auto folder = "/sys/class/net/" + interface;
    // Its name becomes part of file names and of rules: one with quotes or slashes is none.
    const bool plain =
        !interface.empty() && interface.front() != '.' &&
        interface.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-") == std::string::npos;
    const bool shown = plain && files.exists(folder);
    const auto names = ports.names();
    const bool to_be_had = names ? std::find(names->begin(), names->end(), interface) != names->end() : shown;
    if (shown) p.place = to_be_had ? PortPlace::here : PortPlace::elsewhere;
    else if (plain && to_be_had) p.place = PortPlace::unseen;
    if (p.place == PortPlace::here) facts_of_one_that_is_here(p, files, ports);
    else p.others = names;
    if (p.others) std::erase(*p.others, "lo");
    return p;
}

}  // namespace taktwerk::apps
