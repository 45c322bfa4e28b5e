#pragma once
// Commands that come over LCM: command_v1_t judged byte by byte, handed to the gateway, answered with acknowledge_v1_t. Only
// where the configuration allows it. One thread, not real-time.

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "hmi_bridge/gateway/gateway.hpp"
#include "hmi_bridge/lcm/channels.hpp"
#include "hmi_bridge/lcm/message_bus.hpp"

namespace taktwerk::hmi {

class LcmCommandReceiver {
public:
    static constexpr std::size_t max_clients = 16;
    /// A client that has been silent this long gives way to a new one.
    static constexpr Duration idle_client = std::chrono::seconds{10};

    LcmCommandReceiver(Gateway& gateway, std::function<std::int64_t()> wall_utime)
        : gateway_(gateway), wall_utime_(std::move(wall_utime)) {}

    /// Any bytes. What is no command_v1_t of this version is counted and dropped, without an answer: nobody is known to answer to.
    void receive(std::span<const std::byte> message, Instant now);
    /// A reply of the gateway with Source::lcm: publishes the acknowledgement.
    void deliver(const CommandReply& reply, MessageBus& bus, const Channels& channels);
    [[nodiscard]] std::uint64_t rejected() const noexcept { return rejected_; }

private:
    struct Known {
        ClientId client = 0;
        Instant heard{};
    };
    ClientId client_for(std::int64_t lcm_client, Instant now);

    Gateway& gateway_;
    std::function<std::int64_t()> wall_utime_;
    std::map<std::int64_t, Known> clients_;
    std::uint64_t rejected_ = 0;
    std::int64_t acknowledge_seq_ = 0;
    std::vector<std::byte> buffer_;
};

}  // namespace taktwerk::hmi
