#include "runtime/replay/replay_transport.hpp"

#include <algorithm>

namespace taktwerk::runtime {

bool ReplayTransport::is_mine(RecordChannel channel) noexcept {
    switch (channel) {
        case frame_channel:
        case half_frame_channel:
        case departure_channel:
        case refused_channel:
        case link_channel:
        case ring_channel: return true;
        default: return false;
    }
}

bool ReplayTransport::put(const RecordView& record) {
    switch (record.channel) {
        case departure_channel:
        case refused_channel:
            if (!read_hash(record.bytes)) return false;
            leaving_.push_back({record.time, record.channel == refused_channel});
            return true;
        case link_channel:
            if (!read_link(record.bytes)) return false;
            break;
        case ring_channel:
            if (!read_ring(record.bytes)) return false;
            break;
        default:
            if (record.bytes.size() > ecat::max_frame_size) return false;
            break;
    }
    arriving_.push_back(record);
    return true;
}

void ReplayTransport::clear() noexcept {
    arriving_.clear();
    leaving_.clear();
}

bool ReplayTransport::send(std::span<const std::byte>, Instant now) noexcept {
    left_ = now;
    if (leaving_.empty()) return true;
    const auto sent = leaving_.front();
    leaving_.pop_front();
    left_ = sent.at;
    return !sent.refused;
}

Instant ReplayTransport::departure(Instant now) const noexcept { return left_.value_or(now); }

std::optional<ecat::ReceivedFrame> ReplayTransport::receive(std::span<std::byte> buffer, Instant) noexcept {
    while (!arriving_.empty()) {
        const auto record = arriving_.front();
        arriving_.pop_front();
        if (record.channel == link_channel) {
            link_up_ = read_link(record.bytes).value_or(link_up_);
        } else if (record.channel == ring_channel) {
            state_ = read_ring(record.bytes).value_or(state_);
        } else {
            const auto size = std::min(record.bytes.size(), buffer.size());
            std::copy_n(record.bytes.begin(), size, buffer.begin());
            return ecat::ReceivedFrame{size, record.time, record.channel == half_frame_channel};
        }
    }
    return std::nullopt;
}

}  // namespace taktwerk::runtime
