#include "hmi_bridge/web/account/login_gate.hpp"

#include <arpa/inet.h>

#include <algorithm>

#include <fmt/format.h>

#include "hmi_bridge/web/page_origin.hpp"

namespace taktwerk::hmi::web {
namespace {

/// Until `used` is below `most` again.
Duration until_below(double used, double most) {
    return used < most ? Duration{} : std::max(from_seconds((used - most + 1) * to_seconds(LoginGate::one_more)), Duration{1});
}

/// Whose tries an address has.
std::string network_of(std::string_view address) {
    in6_addr six{};
    if (::inet_pton(AF_INET6, std::string(address.substr(0, address.find('%'))).c_str(), &six) != 1 || is_loopback(address))
        return std::string(address);
    std::string network = "net ";
    for (int i = 0; i < 8; ++i) network += fmt::format("{:02x}", six.s6_addr[i]);
    return network;
}

}  // namespace

double LoginGate::Bucket::used_at(Instant now) {
    used = std::max(0.0, used - to_seconds(now - at) / to_seconds(one_more));
    at = now;
    return used;
}

Duration LoginGate::ask(std::string_view user, std::string_view address, Instant now) {
    const auto network = network_of(address);
    if (auto* pair = known(user, network)) {
        const auto wait = until_below(pair->tries.used_at(now), most_tries);
        if (wait == Duration{}) pair->tries.used += 1;
        return wait;
    }
    auto& of_user = by_user_[slot(user)];
    auto& of_address = by_address_[slot(network)];
    if (of_address.used_at(now) == 0) has_failed_[slot(network)] = false;
    const double share = has_failed_[slot(network)] ? most_tries / 2 : most_tries;
    const bool here = is_loopback(address);  // strangers who spend a name's tries lock nobody out of the computer that he stands at
    const auto wait = std::max(here ? Duration{} : until_below(of_user.used_at(now), share), until_below(of_address.used, most_tries));
    if (wait == Duration{}) {
        if (!here) of_user.used += 1;
        of_address.used += 1;
    }
    return wait;
}

void LoginGate::succeeded(std::string_view user, std::string_view address, Instant now) {
    const auto network = network_of(address);
    if (auto* pair = known(user, network)) {
        pair->tries = {0, now};
        return;
    }
    if (known_.size() >= known_pairs) known_.pop_front();
    known_.push_back({std::string(user), network, {0, now}});
    auto& of_user = by_user_[slot(user)];
    auto& of_address = by_address_[slot(network)];
    if (!is_loopback(address)) of_user.used = std::max(0.0, of_user.used - 1);
    of_address.used = std::max(0.0, of_address.used - 1);
}

void LoginGate::failed(std::string_view user, std::string_view address) {
    const auto network = network_of(address);
    if (known(user, network) == nullptr) has_failed_[slot(network)] = true;
}

bool LoginGate::knows(std::string_view user, std::string_view address) const {
    const auto network = network_of(address);
    return std::any_of(known_.begin(), known_.end(), [&](const Pair& pair) { return pair.user == user && pair.address == network; });
}

std::size_t LoginGate::slot(std::string_view text) const {
    std::uint64_t hash = 0xcbf29ce484222325u ^ seed_;  // FNV-1a, then mixed
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    hash ^= seed_ >> 17;
    hash = (hash ^ hash >> 31) * 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(hash >> 40) % slots;
}

LoginGate::Pair* LoginGate::known(std::string_view user, const std::string& network) {
    const auto found =
        std::find_if(known_.begin(), known_.end(), [&](const Pair& pair) { return pair.user == user && pair.address == network; });
    return found == known_.end() ? nullptr : &*found;
}

}  // namespace taktwerk::hmi::web
