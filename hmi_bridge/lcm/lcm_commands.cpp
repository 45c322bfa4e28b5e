#include "hmi_bridge/lcm/lcm_commands.hpp"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "taktwerk_lcm/acknowledge_v1_t.hpp"
#include "taktwerk_lcm/command_v1_t.hpp"

namespace taktwerk::hmi {

using taktwerk_lcm::acknowledge_v1_t;
using taktwerk_lcm::command_v1_t;

namespace {

static_assert(static_cast<int>(CommandKind::take_control) == command_v1_t::KIND_TAKE_CONTROL);
static_assert(static_cast<int>(CommandKind::jog) == command_v1_t::KIND_JOG);
static_assert(static_cast<int>(CommandKind::shutdown) == command_v1_t::KIND_SHUTDOWN);
static_assert(static_cast<int>(protocol_version) == command_v1_t::PROTOCOL_VERSION);

/// Microseconds as a Duration, without overflow: more than a day is a day.
Duration bounded_age(std::int64_t now_us, std::int64_t sent_us) {
    constexpr std::int64_t day = 86'400'000'000;
    if (sent_us < 0 || sent_us < now_us - day) return std::chrono::microseconds{day};
    if (sent_us > now_us + day) return std::chrono::microseconds{-day};
    return std::chrono::microseconds{now_us - sent_us};
}

}  // namespace

ClientId LcmCommandReceiver::client_for(std::int64_t lcm_client, Instant now) {
    if (const auto found = clients_.find(lcm_client); found != clients_.end()) {
        found->second.heard = now;
        return found->second.client;
    }
    if (clients_.size() >= max_clients) {
        const auto oldest = std::min_element(clients_.begin(), clients_.end(),
                                             [](const auto& a, const auto& b) { return a.second.heard < b.second.heard; });
        if (now - oldest->second.heard < idle_client) return 0;
        gateway_.close(oldest->second.client);
        clients_.erase(oldest);
    }
    const auto client = gateway_.open(Source::lcm, fmt::format("LCM client {}", lcm_client), Rights::operating);
    if (client != 0) clients_[lcm_client] = {client, now};
    return client;
}

void LcmCommandReceiver::receive(std::span<const std::byte> message, Instant now) {
    command_v1_t command;
    std::memset(&command, 0, sizeof command);
    // The size is checked before the generated decoder sees a byte; it checks the fingerprint.
    const bool decoded = message.size() == static_cast<std::size_t>(command.getEncodedSize()) &&
                         command.decode(message.data(), 0, static_cast<int>(message.size())) == static_cast<int>(message.size());
    const auto* name = reinterpret_cast<const char*>(command.target);
    const auto length = ::strnlen(name, sizeof command.target);
    const bool padded = std::all_of(name + length, name + sizeof command.target, [](char c) { return c == 0; });
    const bool sound = decoded && command.protocol_version == protocol_version && command.client_id != 0 && command.seq >= 1 &&
                       command.utime > 0 && (command.press == 0 || command.press == 1) && command.mode >= 0 &&
                       command.mode <= command_v1_t::MODE_AUTOMATIC && length < sizeof command.target && padded;
    const auto client = sound ? client_for(command.client_id, now) : 0;
    if (client == 0) {
        ++rejected_;
        return;
    }
    CommandRequest request;
    request.client = client;
    request.sequence = static_cast<std::uint64_t>(command.seq);
    request.kind = static_cast<CommandKind>(command.command_kind);
    request.target.assign(name, length);
    request.press = command.press != 0;
    request.mode = static_cast<runtime::Mode>(command.mode);
    request.value = command.value;
    request.value2 = command.value2;
    request.valid_for = std::chrono::milliseconds{command.valid_for_ms};
    request.age = bounded_age(wall_utime_(), command.utime);
    gateway_.handle(request, now);
}

void LcmCommandReceiver::deliver(const CommandReply& reply, MessageBus& bus, const Channels& channels) {
    const auto known =
        std::find_if(clients_.begin(), clients_.end(), [&](const auto& entry) { return entry.second.client == reply.client; });
    if (known == clients_.end()) return;
    acknowledge_v1_t message{};
    message.utime = wall_utime_();
    message.seq = ++acknowledge_seq_;
    message.protocol_version = protocol_version;
    message.client_id = known->first;
    message.command_seq = static_cast<std::int64_t>(reply.sequence);
    message.answer = static_cast<std::int32_t>(reply.answer);
    message.axis_error = static_cast<std::int32_t>(reply.axis_error);
    message.code = reply.error.code;
    message.subject = reply.error.subject;
    message.text = reply.error.what;
    message.remedy = reply.error.remedy;
    buffer_.resize(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(buffer_.data(), 0, static_cast<int>(buffer_.size()));
    bus.publish(channels.acknowledge(), buffer_);
}

}  // namespace taktwerk::hmi
