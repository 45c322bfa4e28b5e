#pragma once
// LCM for whoever listens in a loop that must not wait: opened on a thread of its own, since a receiver waits for LCM's own test message, ten seconds where multicast
// does not come back.

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/result.hpp"
#include "hmi_bridge/lcm/lcm_bus.hpp"

namespace taktwerk::hmi {

class LcmOpening {
public:
    /// Messages that wait for poll(); beyond it LCM drops the newest.
    static constexpr int room = 16;

    /// `handler` is called by poll() of the bus.
    LcmOpening(const LcmUrl& url, const std::string& channel, MessageBus::Handler handler);
    /// The bus, subscribed, or why there is none; nothing: not yet. Once. Errors: those of LcmBus::open(), hmi.no_multicast_loop.
    [[nodiscard]] std::optional<Result<std::unique_ptr<LcmBus>>> take();

private:
    struct Shared;
    std::shared_ptr<Shared> shared_;  ///< the thread's as well: it may outlive whoever has lost his patience
};

}  // namespace taktwerk::hmi
