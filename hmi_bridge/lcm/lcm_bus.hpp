#pragma once
// The message bus over LCM. Service side only. With subscriptions LCM runs a receiving thread of its own; publishing alone does not.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "core/time.hpp"
#include "hmi_bridge/lcm/lcm_url.hpp"
#include "hmi_bridge/lcm/message_bus.hpp"

namespace taktwerk::hmi {

class LcmBus final : public MessageBus {
public:
    /// Errors: hmi.no_multicast_route (names the two commands that mend it), hmi.lcm (LCM would not start).
    static Result<std::unique_ptr<LcmBus>> open(const LcmUrl& url);
    ~LcmBus() override;

    bool publish(std::string_view channel, std::span<const std::byte> message) override;
    void subscribe(std::string_view channel, Handler handler) override;
    int poll(int most) override;

    /// `received`: us since 1970, by LCM.
    using ChannelHandler = std::function<void(std::string_view channel, std::span<const std::byte> message, std::int64_t received)>;
    /// Every channel whose whole name this regular expression (GLib's) is. `room`: messages that wait; what comes beyond it LCM drops without a word. Before the first
    /// poll(). False: it is no regular expression.
    [[nodiscard]] bool subscribe_matching(const std::string& pattern, int room, ChannelHandler handler);
    /// Readable while messages wait for poll(), once something is subscribed; LCM's own, -1: none.
    [[nodiscard]] int descriptor() const;
    /// As poll(), and waits for the first message up to `patience`.
    int wait(Duration patience, int most);

private:
    struct Impl;
    explicit LcmBus(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace taktwerk::hmi
