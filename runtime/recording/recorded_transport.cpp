#include "runtime/recording/recorded_transport.hpp"

#include <algorithm>

#include "runtime/recording/frame_hash.hpp"
#include "runtime/recording/inbox_record.hpp"

namespace taktwerk::runtime {

namespace {

void append_hash(Recorder& recorder, RecordChannel channel, Instant at, std::uint64_t hash) noexcept {
    inbox_record::Bytes<8> bytes;
    bytes.put(hash);
    recorder.append(channel, at, bytes.all());
}

}  // namespace

bool RecordedTransport::send(std::span<const std::byte> frame, Instant now) noexcept {
    const bool taken = inner_.send(frame, now);
    if (recorder_ == nullptr) return taken;
    last_hash_ = frame_hash(frame);
    if (!taken) append_hash(*recorder_, refused_channel, now, last_hash_);
    return taken;
}

Instant RecordedTransport::departure(Instant now) const noexcept {
    const Instant left = inner_.departure(now);
    if (recorder_ != nullptr) append_hash(*recorder_, departure_channel, left, last_hash_);
    return left;
}

std::optional<ecat::ReceivedFrame> RecordedTransport::receive(std::span<std::byte> buffer, Instant now) noexcept {
    const auto received = inner_.receive(buffer, now);
    link_up_ = inner_.link_up();
    if (recorder_ == nullptr) return received;
    note_line(now);
    if (received)
        recorder_->append(received->half ? half_frame_channel : frame_channel, received->at,
                          std::span<const std::byte>{buffer}.first(std::min(received->size, buffer.size())));
    return received;
}

void RecordedTransport::note_line(Instant now) noexcept {
    if (link_up_ != recorded_link_) {
        recorded_link_ = link_up_;
        inbox_record::Bytes<1> bytes;
        bytes.put(static_cast<std::uint8_t>(link_up_ ? 1 : 0));
        recorder_->append(link_channel, now, bytes.all());
    }
    if (ring_ == nullptr || ring_->state() == recorded_ring_) return;
    const auto& ring = recorded_ring_ = ring_->state();
    inbox_record::Bytes<15> bytes;
    bytes.put(static_cast<std::uint8_t>(ring.shape));
    bytes.put(ring.before_break);
    bytes.put(ring.behind_break);
    bytes.put(ring.opened);
    bytes.put(ring.whole);
    recorder_->append(ring_channel, now, bytes.all());
}

}  // namespace taktwerk::runtime
