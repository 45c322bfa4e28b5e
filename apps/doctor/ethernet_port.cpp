#include "apps/doctor/ethernet_port.hpp"

#include <linux/ethtool.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

constexpr std::array names{"rx-usecs", "tx-usecs", "adaptive-rx", "eee"};

/// One question; false: errno says why.
template <class Request>
bool ask(const std::string& interface, Request& request) {
    if (interface.empty() || interface.size() >= IFNAMSIZ) return errno = ENODEV, false;
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket < 0) return false;
    ifreq wish{};
    std::copy(interface.begin(), interface.end(), wish.ifr_name);
    wish.ifr_data = reinterpret_cast<char*>(&request);
    const bool answered = ::ioctl(socket, SIOCETHTOOL, &wish) == 0;
    const int number = errno;
    ::close(socket);
    errno = number;
    return answered;
}

template <class Request>
bool get(const std::string& interface, Request& request, std::uint32_t command) {
    request = {};
    request.cmd = command;
    return ask(interface, request);
}

}  // namespace

const char* name(EthernetKnob knob) noexcept { return names[static_cast<std::size_t>(knob)]; }

std::optional<EthernetKnob> ethernet_knob(const std::string& name) noexcept {
    const auto at = std::find(names.begin(), names.end(), name);
    return at == names.end() ? std::nullopt : std::optional{static_cast<EthernetKnob>(at - names.begin())};
}

std::optional<std::uint32_t> value_of(const EthernetSettings& settings, EthernetKnob knob) noexcept {
    const auto bit = [](std::optional<bool> on) { return on ? std::optional<std::uint32_t>{*on ? 1 : 0} : std::nullopt; };
    switch (knob) {
        case EthernetKnob::receive_us: return settings.receive_us;
        case EthernetKnob::send_us: return settings.send_us;
        case EthernetKnob::adaptive_receive: return bit(settings.adaptive_receive);
        case EthernetKnob::energy_efficient: return bit(settings.energy_efficient);
    }
    return std::nullopt;
}

std::optional<std::vector<std::string>> KernelEthernetPorts::names() const {
    struct if_nameindex* const all = ::if_nameindex();
    if (all == nullptr) return std::nullopt;
    std::vector<std::string> found;
    for (const auto* one = all; one->if_index != 0; ++one) found.emplace_back(one->if_name);
    ::if_freenameindex(all);
    std::sort(found.begin(), found.end());
    return found;
}

EthernetSettings KernelEthernetPorts::read(const std::string& interface) const {
    EthernetSettings s;
    ethtool_drvinfo driver;
    if (get(interface, driver, ETHTOOL_GDRVINFO)) s.driver.assign(driver.driver, ::strnlen(driver.driver, sizeof driver.driver));
    ethtool_coalesce coalesce;
    if (get(interface, coalesce, ETHTOOL_GCOALESCE)) {
        s.receive_us = coalesce.rx_coalesce_usecs;
        s.send_us = coalesce.tx_coalesce_usecs;
        s.adaptive_receive = coalesce.use_adaptive_rx_coalesce != 0;
    }
    ethtool_eee eee;
    if (get(interface, eee, ETHTOOL_GEEE)) {
        s.energy_efficient = eee.eee_enabled != 0;
        s.energy_efficient_now = eee.eee_active != 0;
    }
    return s;
}

Result<void> KernelEthernetPorts::set(const std::string& interface, EthernetKnob knob, std::uint32_t value) {
    bool done = false;
    if (knob == EthernetKnob::energy_efficient) {
        ethtool_eee eee;
        done = get(interface, eee, ETHTOOL_GEEE);
        eee.cmd = ETHTOOL_SEEE;
        eee.eee_enabled = value;
        done = done && ask(interface, eee);
    } else {
        ethtool_coalesce coalesce;
        done = get(interface, coalesce, ETHTOOL_GCOALESCE);
        coalesce.cmd = ETHTOOL_SCOALESCE;
        (knob == EthernetKnob::receive_us ? coalesce.rx_coalesce_usecs
         : knob == EthernetKnob::send_us  ? coalesce.tx_coalesce_usecs
                                          : coalesce.use_adaptive_rx_coalesce) = value;
        done = done && ask(interface, coalesce);
    }
    if (done) return {};
    return Error{"doctor.ethernet", interface, fmt::format("its driver does not take {} {}: {}", name(knob), value, std::strerror(errno)),
                 "leave it, or use a network interface whose driver does"};
}

}  // namespace taktwerk::apps
