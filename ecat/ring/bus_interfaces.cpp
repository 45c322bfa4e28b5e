#include "ecat/ring/bus_interfaces.hpp"

#include <utility>

namespace taktwerk::ecat {

Result<BusInterfaces::End> BusInterfaces::open_end(const std::string& interface, BusTransport by, const RawSocketOptions& options) {
    End end;
    auto packet = RawSocketTransport::open(interface, options);
    if (!packet) return packet.error();
    end.packet = std::move(*packet);
    if (by == BusTransport::packet) return end;
    // Before the stack it gains little over a packet socket and makes everybody else deaf: only who asks for it by name gets it there.
    using Places = XdpProgram::Places;
    auto xdp = XdpTransport::open(*end.packet, by == BusTransport::xdp ? Places::driver_or_stack : Places::driver, options.clock);
    if (xdp) end.xdp = std::move(*xdp);
    else if (by == BusTransport::xdp) return xdp.error();
    else end.instead = xdp.error().what + "; a packet socket (AF_PACKET) is used instead";
    return end;
}

Result<std::unique_ptr<BusInterfaces>> BusInterfaces::open(const std::string& first, const std::string& second, Duration patience,
                                                           BusTransport by, const RawSocketOptions& options) {
    std::unique_ptr<BusInterfaces> interfaces{new BusInterfaces};
    auto& ends = interfaces->ends_;
    auto opened = open_end(first, by, options);
    if (!opened) return opened.error();
    ends[0] = std::move(*opened);
    if (second.empty()) return interfaces;
    auto other = open_end(second, by, options);
    if (!other) return other.error();
    ends[1] = std::move(*other);
    interfaces->ring_ = std::make_unique<RingTransport>(ends[0].transport(), ends[1].transport(), patience);
    return interfaces;
}

void BusInterfaces::refresh() noexcept {
    for (auto& end : ends_) {
        if (end.xdp) end.xdp->refresh();
        else if (end.packet) end.packet->refresh();
    }
}

std::vector<std::string> BusInterfaces::remarks() const {
    std::vector<std::string> all;
    for (const auto& end : ends_) {
        if (!end.packet) continue;
        const auto add = [&](const std::string& remark) { all.push_back(end.packet->interface() + ": " + remark); };
        if (end.xdp) add(end.xdp->text());
        if (!end.instead.empty()) add(end.instead);
        for (const auto& refused : end.packet->report().refused) add(refused);
    }
    return all;
}

std::vector<std::string> BusInterfaces::news() {
    std::vector<std::string> all;
    for (auto& end : ends_)
        if (end.xdp)
            if (auto said = end.xdp->news(); !said.empty()) all.push_back(std::move(said));
    return all;
}

}  // namespace taktwerk::ecat
