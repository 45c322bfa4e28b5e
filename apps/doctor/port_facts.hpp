#pragma once
// A network interface that an EtherCAT bus shall be at, and who else has something to do with it. Facts only. Not real-time.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/doctor/ethernet_port.hpp"
#include "apps/doctor/host_files.hpp"

namespace taktwerk::apps {

/// Sockets are of the network namespace of this process, what /sys/class/net shows of the one in which /sys was mounted: mostly the same.
enum class PortPlace : std::uint8_t {
    nowhere,
    here,
    unseen,     ///< sockets can have it, and /sys does not show it
    elsewhere,  ///< /sys shows it, and no socket can have it
};

struct PortFacts {
    std::string name;
    PortPlace place = PortPlace::nowhere;            ///< the rest is known of one that is here
    std::optional<std::vector<std::string>> others;  ///< not here: what sockets can have, the loopback aside; nothing: not known
    bool up = false, carrier = false;
    int index = 0;
    double megabit = 0;  ///< of the link; 0: not known
    std::string duplex;
    std::string bus;     ///< "pci", "usb"; empty: no hardware (veth, tap)
    std::string master;  ///< the bridge or bond that has it; empty: none
    EthernetSettings ethernet;
    std::vector<int> irqs;                    ///< its interrupts
    std::vector<int> irq_cpus;                ///< CPUs that they may go to, all together; empty: not known
    bool routed = false;                      ///< IP frames are routed over it: it has an IPv4 address
    std::vector<std::string> ipv6_addresses;  ///< of the kernel's own making, too
    std::optional<bool> ipv6;                 ///< switched on at this interface
    std::vector<std::string> managers;        ///< "NetworkManager", "systemd-networkd", "dhclient": who configures it
    bool other_master = false;                ///< somebody has an EtherCAT socket (88A4h) on it
};

[[nodiscard]] PortFacts port_facts(const HostFiles& files, const EthernetPorts& ports, const std::string& interface);

}  // namespace taktwerk::apps
