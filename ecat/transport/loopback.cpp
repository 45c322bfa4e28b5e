#include "ecat/transport/loopback.hpp"

#include <algorithm>

namespace taktwerk::ecat {

namespace {
bool strikes(std::uint32_t& counter) noexcept {
    if (counter == 0) return false;
    --counter;
    return true;
}
}  // namespace

LoopbackTransport::LoopbackTransport(FrameSink& sink, std::size_t slots, const MacAddress& mac) : sink_(&sink), slots_(slots), mac_(mac) {}

LoopbackTransport::Slot* LoopbackTransport::free_slot() noexcept {
    for (auto& slot : slots_)
        if (slot.size == 0) return &slot;
    return nullptr;
}

LoopbackTransport::Slot* LoopbackTransport::earliest() noexcept {
    Slot* first = nullptr;
    for (auto& slot : slots_) {
        if (slot.size == 0) continue;
        if (first == nullptr || slot.arrival < first->arrival || (slot.arrival == first->arrival && slot.order < first->order))
            first = &slot;
    }
    return first;
}

bool LoopbackTransport::send(std::span<const std::byte> frame, Instant now) noexcept {
    if (faults.link_down || frame.empty() || frame.size() > max_frame_size) return false;
    Slot* slot = free_slot();
    if (slot == nullptr) return false;
    sink_->advance(now);
    if (strikes(faults.drop_requests)) return true;

    std::copy(frame.begin(), frame.end(), slot->bytes.begin());
    const auto bytes = std::span{slot->bytes}.first(frame.size());
    const auto flight = sink_->process(bytes, now);
    if (!flight || strikes(faults.drop_answers)) return true;
    const bool elsewhere = other_end_ != nullptr && sink_->came_out_elsewhere();

    slot->size = frame.size();
    slot->arrival = now + *flight;
    slot->order = order_++;
    for (auto& held : slots_) {
        if (held.size == 0 || !held.overtaken || &held == slot) continue;
        held.overtaken = false;
        held.arrival = slot->arrival;
        held.order = order_++;
    }
    slot->overtaken = strikes(faults.reorder_answers);
    if (slot->overtaken) slot->arrival = Instant::max();
    else if (strikes(faults.delay_answers)) slot->arrival += faults.delay;
    if (strikes(faults.corrupt_answers)) {
        const std::size_t bit = faults.corrupt_bit % (frame.size() * 8);
        bytes[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
    }
    if (strikes(faults.duplicate_answers)) {
        if (Slot* copy = free_slot(); copy != nullptr) {
            *copy = *slot;
            copy->order = order_++;
            if (elsewhere) other_end_->take_over(*copy);
        }
    }
    if (elsewhere) other_end_->take_over(*slot);
    return true;
}

/// A frame that comes out here and not where it was sent.
void LoopbackTransport::take_over(Slot& sent) noexcept {
    if (Slot* slot = free_slot(); slot != nullptr) {
        *slot = sent;
        slot->order = order_++;
    }
    sent.size = 0;
}

void LoopbackTransport::lose_under_way(Instant now) noexcept {
    for (auto& slot : slots_)
        if (slot.arrival > now) slot.size = 0;
}

void LoopbackTransport::inject(std::span<const std::byte> frame, Instant arrival) noexcept {
    Slot* slot = free_slot();
    if (slot == nullptr || frame.empty() || frame.size() > max_frame_size) return;
    std::copy(frame.begin(), frame.end(), slot->bytes.begin());
    slot->size = frame.size();
    slot->arrival = arrival;
    slot->order = order_++;
}

std::optional<ReceivedFrame> LoopbackTransport::receive(std::span<std::byte> buffer, Instant now) noexcept {
    sink_->advance(now);
    if (faults.link_down) return std::nullopt;
    Slot* slot = earliest();
    if (slot == nullptr || slot->arrival > now) return std::nullopt;
    const ReceivedFrame received{std::min(slot->size, buffer.size()), slot->arrival};
    std::copy_n(slot->bytes.begin(), received.size, buffer.begin());
    slot->size = 0;
    return received;
}

std::optional<Instant> LoopbackTransport::next_arrival() const noexcept {
    std::optional<Instant> next;
    for (const auto& slot : slots_)
        if (slot.size != 0 && (!next || slot.arrival < *next)) next = slot.arrival;
    return next;
}

}  // namespace taktwerk::ecat
