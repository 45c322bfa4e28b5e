#include "ecat/eoe/ethernet_bridge.hpp"

#include <algorithm>
#include <utility>

namespace taktwerk::ecat {

namespace {

constexpr Duration host_poll_period = std::chrono::microseconds{200};
constexpr int frames_at_once = 16;  ///< of this computer, at one look
constexpr std::size_t mac_size = std::tuple_size_v<EoeMac>;

EoeMac mac_at(std::span<const std::byte> frame, std::size_t at) noexcept {
    EoeMac mac;
    std::copy_n(frame.begin() + static_cast<std::ptrdiff_t>(at), mac.size(), mac.begin());
    return mac;
}

/// For more than one: multicast and broadcast.
bool is_group(const EoeMac& mac) noexcept { return (mac[0] & std::byte{1}) != std::byte{0}; }

}  // namespace

void EthernetBridge::add(MailboxEndpoint& mailbox) {
    const std::size_t side = links_.size();
    links_.push_back(std::make_unique<EthernetLink>(mailbox, [this, side](std::span<const std::byte> frame) { pass(frame, side); }));
}

const EthernetBridge::Known* EthernetBridge::find(const EoeMac& mac) const noexcept {
    const auto found = std::find_if(known_.begin(), known_.end(), [&](const Known& known) { return known.mac == mac; });
    return found == known_.end() ? nullptr : &*found;
}

void EthernetBridge::learn(const EoeMac& mac, std::size_t side) {
    if (is_group(mac)) return;
    const auto found = std::find_if(known_.begin(), known_.end(), [&](const Known& known) { return known.mac == mac; });
    if (found != known_.end()) {
        found->side = side;
        return;
    }
    if (known_.size() >= most_addresses) known_.erase(known_.begin());
    known_.push_back({mac, side});
}

void EthernetBridge::pass(std::span<const std::byte> frame, std::size_t from) {
    if (frame.size() < shortest_ethernet_frame) return;
    learn(mac_at(frame, mac_size), from);
    const EoeMac to = mac_at(frame, 0);
    const Known* known = is_group(to) ? nullptr : find(to);
    if (known != nullptr) {
        if (known->side != from) deliver(frame, known->side);
        return;
    }
    if (from != host_side) deliver(frame, host_side);
    for (std::size_t side = 0; side < links_.size(); ++side)
        if (side != from) deliver(frame, side);
}

void EthernetBridge::deliver(std::span<const std::byte> frame, std::size_t to) {
    if (to != host_side) return links_[to]->send(frame);
    if (host_.send(frame)) ++to_host_;
}

void EthernetBridge::poll_host() {
    for (int i = 0; i < frames_at_once; ++i) {
        const auto size = host_.receive(buffer_);
        if (!size) return;
        ++from_host_;
        pass(std::span{buffer_}.first(*size), host_side);
    }
}

Script<Result<void>> EthernetBridge::carry(DatagramPort& port, std::optional<Instant> until) {
    std::vector<BasicRunner<Result<void>>> carriers;
    carriers.reserve(links_.size());
    for (const auto& link : links_) carriers.emplace_back(link->carry(port));
    Instant now = co_await time();
    while (!until || now < *until) {
        poll_host();
        if (host_.gone())
            co_return Error{"eoe.tap", "the interface", "somebody deleted it: nobody can reach the slaves through it any more",
                            "start the command again"};
        for (auto& carrier : carriers) {
            carrier.step(now);
            if (carrier.done()) co_return carrier.result();
        }
        now = co_await pause(host_poll_period);
    }
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat
