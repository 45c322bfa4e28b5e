#include "ecat/exchange/exchange.hpp"

#include <algorithm>

#include "core/bytes.hpp"

namespace taktwerk::ecat {

namespace {

std::uint8_t first_index(std::uint32_t generation) noexcept { return static_cast<std::uint8_t>(generation & 0xFFu); }

std::uint8_t index_of(std::uint32_t generation, std::size_t datagram) noexcept {
    return static_cast<std::uint8_t>((generation >> (8 * (datagram % 4))) & 0xFFu);
}

}  // namespace

struct Exchange::Slot {
    struct Layout {
        std::uint16_t header = 0;  ///< offset of the datagram's header in the frame
        std::uint16_t size = 0;    ///< bytes of data
        std::uint16_t passed = 0;  ///< slaves, from the answer
    };
    Buffer bytes;
    std::optional<FrameBuilder> builder;
    std::array<Layout, max_datagrams> layout;
    std::size_t count = 0;
    std::size_t end = 0;   ///< where the next datagram begins
    std::size_t size = 0;  ///< of the finished frame
    std::uint32_t generation = 0;
    SlotState state = SlotState::free;
    FrameKind kind = FrameKind::cyclic;
    bool echoed = false, half = false;
    Instant sent_at{}, departed_at{}, arrived_at{};

    [[nodiscard]] bool fits_answer(FrameReader& reader, Datagram datagram) noexcept;
};

Exchange::Exchange(Transport& transport)
    : transport_(transport),
      source_(transport.mac()),
      slots_(std::make_unique<std::array<Slot, slot_count>>()),
      scratch_(std::make_unique<Buffer>()) {
    source_[0] = static_cast<std::uint8_t>(source_[0] & ~0x02u);
}

Exchange::~Exchange() = default;

Exchange::Slot* Exchange::find(SlotId id) const noexcept {
    if (id.slot >= slot_count || id.generation == 0) return nullptr;
    auto& slot = (*slots_)[id.slot];
    return slot.state != SlotState::free && slot.generation == id.generation ? &slot : nullptr;
}

Exchange::Slot* Exchange::carrier(std::uint8_t index) const noexcept {
    auto& slot = (*slots_)[slot_of_[index]];
    return slot.state != SlotState::free && first_index(slot.generation) == index ? &slot : nullptr;
}

bool Exchange::is_ours(std::span<const std::byte> frame) const noexcept {
    constexpr std::size_t source_at = 6;
    for (std::size_t i = 0; i < source_.size(); ++i) {
        const auto locally_administered = static_cast<std::uint8_t>(i == 0 ? 0x02 : 0x00);
        if ((static_cast<std::uint8_t>(frame[source_at + i]) & ~locally_administered) != source_[i]) return false;
    }
    return true;
}

void Exchange::next_generation() noexcept {
    for (;;) {
        ++generation_;
        const auto index = first_index(generation_);
        if (generation_ == 0 || carrier(index) != nullptr) continue;
        if (past_[index] != Past::lost) return;
        past_[index] = Past::quarantined;  // its answer may still come: leave the index alone this round
    }
}

std::optional<SlotId> Exchange::begin(FrameKind kind) noexcept {
    const auto slot = std::find_if(slots_->begin(), slots_->end(), [](const Slot& s) { return s.state == SlotState::free; });
    if (slot == slots_->end()) return std::nullopt;
    next_generation();
    slot->state = SlotState::building;
    slot->kind = kind;
    slot->generation = generation_;
    slot->count = 0;
    slot->end = ethernet_header_size + ecat_header_size;
    slot->size = 0;
    slot->echoed = slot->half = false;
    slot->builder.emplace(slot->bytes, source_);
    slot_of_[first_index(generation_)] = static_cast<std::uint8_t>(slot - slots_->begin());
    return SlotId{static_cast<std::uint8_t>(slot - slots_->begin()), generation_};
}

bool Exchange::fits(SlotId id, std::size_t data_size) const noexcept {
    const auto* slot = find(id);
    return slot != nullptr && slot->state == SlotState::building && slot->count < max_datagrams && slot->builder->fits(data_size);
}

std::optional<DatagramRef> Exchange::add(SlotId id, Command command, Address address, std::size_t data_size) noexcept {
    if (!fits(id, data_size)) return std::nullopt;
    auto& slot = *find(id);
    const std::size_t number = slot.count++;
    slot.layout[number] = {static_cast<std::uint16_t>(slot.end), static_cast<std::uint16_t>(data_size), 0};
    slot.end += datagram_overhead + data_size;
    return DatagramRef{number, slot.builder->add(command, index_of(slot.generation, number), address, data_size)};
}

bool Exchange::send(SlotId id, Instant now) noexcept {
    auto* slot = find(id);
    if (slot == nullptr || slot->state != SlotState::building) return false;
    slot->sent_at = slot->departed_at = now;
    const auto frame = slot->builder->finish();
    slot->size = frame.size();
    if (slot->count == 0 || !transport_.send(frame, now)) {
        slot->state = SlotState::lost;
        ++statistics_.send_errors;
        return false;
    }
    slot->departed_at = transport_.departure(now);
    slot->state = SlotState::sent;
    past_[first_index(slot->generation)] = Past::in_flight;
    ++statistics_.sent;
    if (tap_ != nullptr) tap_(tap_context_, frame, slot->departed_at, true);
    return true;
}

std::size_t Exchange::receive(Instant now) noexcept {
    std::size_t answered = 0;
    for (std::size_t i = 0; i < frames_per_receive; ++i) {
        const auto received = transport_.receive(*scratch_, now);
        if (!received) break;
        const auto frame = std::span<const std::byte>{*scratch_}.first(std::min(received->size, scratch_->size()));
        if (tap_ != nullptr) tap_(tap_context_, frame, received->at, false);
        if (match(frame, *received)) ++answered;
    }
    return answered;
}

/// True when the answer has exactly the datagrams that were sent.
bool Exchange::Slot::fits_answer(FrameReader& reader, Datagram datagram) noexcept {
    for (std::size_t i = 0;; ++i) {
        const auto head = std::span<const std::byte>{bytes}.subspan(layout[i].header, datagram_header_size);
        const auto command = static_cast<Command>(head[0]);
        const Address asked{load_le<std::uint32_t>(head, 2)};
        if (datagram.command != command || datagram.index != static_cast<std::uint8_t>(head[1]) || datagram.data.size() != layout[i].size)
            return false;
        if (counts_slaves(command) ? datagram.address.ado() != asked.ado() : datagram.address != asked) return false;
        layout[i].passed = counts_slaves(command) ? static_cast<std::uint16_t>(datagram.address.adp() - asked.adp()) : std::uint16_t{0};
        const auto next = reader.next();
        if (i + 1 == count) return !next && reader.error() == FrameError::none;
        if (!next) return false;
        datagram = *next;
    }
}

bool Exchange::match(std::span<const std::byte> frame, const ReceivedFrame& received) noexcept {
    FrameReader reader{frame};
    const auto first = reader.next();
    if (!first) {
        ++statistics_.rejected;
        return false;
    }
    if (!is_ours(frame)) {
        ++statistics_.foreign;
        std::transform(frame.begin() + 6, frame.begin() + 12, statistics_.foreign_source.begin(),
                       [](std::byte b) { return std::to_integer<std::uint8_t>(b); });
        return false;
    }
    auto& past = past_[first->index];
    auto* slot = carrier(first->index);
    if (slot == nullptr || slot->state != SlotState::sent) {
        count_stray(past);
        return false;
    }
    if (!slot->fits_answer(reader, *first)) {
        ++statistics_.rejected;
        return false;
    }
    if (frame.size() >= slot->size &&
        std::equal(slot->bytes.begin(), slot->bytes.begin() + static_cast<std::ptrdiff_t>(slot->size), frame.begin())) {
        ++statistics_.echoes;
        slot->echoed = true;
        slot->half = received.half;
        slot->arrived_at = received.at;
        return false;
    }
    std::copy_n(frame.begin(), std::min(frame.size(), slot->end), slot->bytes.begin());
    slot->state = SlotState::answered;
    slot->half = received.half;
    slot->arrived_at = received.at;
    past = Past::answered;
    ++statistics_.received;
    return true;
}

/// An answer that nobody waits for.
void Exchange::count_stray(Past& past) noexcept {
    switch (past) {
        case Past::lost:
        case Past::quarantined:
            ++statistics_.late;
            past = Past::answered;
            break;
        case Past::answered: ++statistics_.duplicate; break;
        case Past::never:
        case Past::in_flight: ++statistics_.rejected; break;
    }
}

void Exchange::give_up(Slot& slot) noexcept {
    slot.state = SlotState::lost;
    past_[first_index(slot.generation)] = Past::lost;
    ++statistics_.lost;
}

void Exchange::expire(Slot& slot) noexcept {
    if (!slot.echoed) {
        give_up(slot);
        return;
    }
    slot.state = SlotState::answered;
    past_[first_index(slot.generation)] = Past::answered;
    ++statistics_.received;
}

void Exchange::expire(Instant now, Duration timeout) noexcept {
    for (auto& slot : *slots_)
        if (slot.state == SlotState::sent && now - slot.sent_at >= timeout) expire(slot);
}

void Exchange::expire(SlotId id) noexcept {
    auto* slot = find(id);
    if (slot != nullptr && slot->state == SlotState::sent) expire(*slot);
}

SlotState Exchange::state(SlotId id) const noexcept {
    const auto* slot = find(id);
    return slot != nullptr ? slot->state : SlotState::free;
}

FrameKind Exchange::kind(SlotId id) const noexcept {
    const auto* slot = find(id);
    return slot != nullptr ? slot->kind : FrameKind::cyclic;
}

std::size_t Exchange::datagrams(SlotId id) const noexcept {
    const auto* slot = find(id);
    return slot != nullptr ? slot->count : 0;
}

std::span<const std::byte> Exchange::data(SlotId id, std::size_t number) const noexcept {
    const auto* slot = find(id);
    if (slot == nullptr || slot->state != SlotState::answered || number >= slot->count) return {};
    const auto& layout = slot->layout[number];
    return std::span<const std::byte>{slot->bytes}.subspan(layout.header + datagram_header_size, layout.size);
}

std::uint16_t Exchange::wkc(SlotId id, std::size_t number) const noexcept {
    const auto* slot = find(id);
    if (slot == nullptr || slot->state != SlotState::answered || number >= slot->count) return 0;
    const auto& layout = slot->layout[number];
    return load_le<std::uint16_t>(slot->bytes, layout.header + datagram_header_size + layout.size);
}

std::uint16_t Exchange::irq(SlotId id, std::size_t number) const noexcept {
    const auto* slot = find(id);
    if (slot == nullptr || slot->state != SlotState::answered || number >= slot->count) return 0;
    return load_le<std::uint16_t>(slot->bytes, slot->layout[number].header + std::size_t{8});
}

std::uint16_t Exchange::slaves_passed(SlotId id, std::size_t number) const noexcept {
    const auto* slot = find(id);
    if (slot == nullptr || slot->state != SlotState::answered || number >= slot->count) return 0;
    return slot->layout[number].passed;
}

Instant Exchange::departed_at(SlotId id) const noexcept {
    const auto* slot = find(id);
    return slot != nullptr ? slot->departed_at : Instant{};
}

std::size_t Exchange::frame_size(SlotId id) const noexcept {
    const auto* slot = find(id);
    return slot != nullptr ? slot->size : 0;
}

bool Exchange::half(SlotId id) const noexcept {
    const auto* slot = find(id);
    return slot != nullptr && slot->half;
}

Instant Exchange::sent_at(SlotId id) const noexcept {
    const auto* slot = find(id);
    return slot != nullptr ? slot->sent_at : Instant{};
}

Duration Exchange::round_trip(SlotId id) const noexcept {
    const auto* slot = find(id);
    return slot != nullptr && slot->state == SlotState::answered ? slot->arrived_at - slot->sent_at : Duration{};
}

void Exchange::release(SlotId id) noexcept {
    auto* slot = find(id);
    if (slot == nullptr) return;
    if (slot->state == SlotState::sent) give_up(*slot);
    slot->state = SlotState::free;
}

void Exchange::set_tap(Tap tap, void* context) noexcept {
    tap_ = tap;
    tap_context_ = context;
}

}  // namespace taktwerk::ecat
