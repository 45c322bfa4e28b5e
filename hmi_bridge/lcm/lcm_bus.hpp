#pragma once
// The message bus over LCM. Service side only. With subscriptions LCM runs a receiving thread of its own; publishing alone does not.

#include <memory>

#include "core/result.hpp"
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

private:
    struct Impl;
    explicit LcmBus(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace taktwerk::hmi
