#pragma once
// Messages on named channels: LCM in the field (lcm_bus.hpp), memory in tests. Service side only: publishing allocates, locks
// and enters the kernel, so nothing of the cycle may reach it. One thread.

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>

namespace taktwerk::hmi {

class MessageBus {
public:
    using Handler = std::function<void(std::span<const std::byte>)>;
    virtual ~MessageBus() = default;
    /// False: the message did not go out (counted by the caller; state is published again anyway).
    virtual bool publish(std::string_view channel, std::span<const std::byte> message) = 0;
    /// Before the first poll(). Exact channel name. The handler gets raw bytes and judges them itself; it must not throw.
    virtual void subscribe(std::string_view channel, Handler handler) = 0;
    /// Hands on what has come, at most `most` messages; never waits. How many there were.
    virtual int poll(int most) = 0;
};

}  // namespace taktwerk::hmi
