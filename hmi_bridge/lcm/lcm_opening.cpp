#include "hmi_bridge/lcm/lcm_opening.hpp"

#include <mutex>
#include <thread>
#include <utility>

namespace taktwerk::hmi {

struct LcmOpening::Shared {
    std::mutex mutex;
    std::optional<Result<std::unique_ptr<LcmBus>>> done;
};

namespace {

Result<std::unique_ptr<LcmBus>> open(const LcmUrl& url, const std::string& channel, MessageBus::Handler handler) {
    auto bus = LcmBus::open(url);
    if (!bus) return bus;
    const bool listens = (*bus)->subscribe_matching(
        channel, LcmOpening::room, [handler = std::move(handler)](std::string_view, auto message, std::int64_t) { handler(message); });
    if (listens) return bus;
    return Error{"hmi.no_multicast_loop", url.text, "what LCM sends to its multicast group does not come back, so nothing can be received",
                 "Run as root: `ip link set lo multicast on` and `ip route add 224.0.0.0/4 dev lo`; look at the firewall."};
}

}  // namespace

LcmOpening::LcmOpening(const LcmUrl& url, const std::string& channel, MessageBus::Handler handler) : shared_(std::make_shared<Shared>()) {
    std::thread([shared = shared_, url, channel, handler = std::move(handler)]() mutable {
        auto bus = open(url, channel, std::move(handler));
        const std::lock_guard lock{shared->mutex};
        shared->done = std::move(bus);
    }).detach();
}

std::optional<Result<std::unique_ptr<LcmBus>>> LcmOpening::take() {
    const std::lock_guard lock{shared_->mutex};
    return std::exchange(shared_->done, std::nullopt);
}

}  // namespace taktwerk::hmi
