#include "ecat/exchange/acyclic_channel.hpp"

#include <algorithm>

namespace taktwerk::ecat {

struct AcyclicChannel::Entry {
    std::atomic<State> state{State::free};
    // Written by the service side while `filling`, by the cycle side while `in_flight` or `abandoned`; else read only.
    std::uint32_t generation = 0;
    std::atomic<std::uint64_t> order{0};  ///< of submission; read by the cycle side before it owns the entry
    Command command{};
    Address address{};
    std::size_t size = 0;
    std::uint16_t wkc = 0;
    std::uint16_t passed = 0;
    Instant sent_at{};
    // The gate, read by the cycle side before it owns the entry. Should the entry change hands meanwhile it leaves too early.
    std::atomic<const std::atomic<std::uint64_t>*> gate_word{nullptr};
    std::atomic<std::uint8_t> gate_bit{0};
    std::atomic<std::uint8_t> gate_entry{0};   ///< which entry it leaves behind
    std::atomic<std::uint64_t> gate_order{0};  ///< `order` of that request, plus 1; 0: none
    std::uint64_t packed_in = 0;               ///< number of the pack() that took it; cycle side alone
    std::array<std::byte, max_datagram_data> data;
};

void EntryTurn::leave() noexcept {
    if (channel_ == nullptr) return;
    (ahead_ != nullptr ? ahead_->behind_ : channel_->first_in_line_) = behind_;
    (behind_ != nullptr ? behind_->ahead_ : channel_->last_in_line_) = ahead_;
    channel_ = nullptr;
    ahead_ = behind_ = nullptr;
}

struct AcyclicChannel::Flight {
    SlotId slot{};
    Instant sent_at{};
    std::size_t count = 0;  ///< 0 = none
    std::array<std::uint8_t, max_datagrams_a_frame> entries{};
};

AcyclicChannel::AcyclicChannel(Exchange& exchange, Duration timeout)
    : exchange_(exchange),
      timeout_(timeout),
      entries_(std::make_unique<std::array<Entry, entry_count>>()),
      flights_(std::make_unique<std::array<Flight, max_frames>>()) {}

AcyclicChannel::~AcyclicChannel() = default;

AcyclicChannel::Entry* AcyclicChannel::find(EntryId id) const noexcept {
    if (id.entry >= entry_count || id.generation == 0) return nullptr;
    auto& entry = (*entries_)[id.entry];
    return entry.generation == id.generation ? &entry : nullptr;
}

std::optional<EntryId> AcyclicChannel::claim(Command command, Address address, std::size_t size, std::span<const std::byte> data,
                                             const SendGate& gate) noexcept {
    if (size > max_datagram_data) return std::nullopt;
    if (gate.exists() && gated() >= max_gated) return std::nullopt;
    for (std::size_t i = 0; i < entry_count; ++i) {
        auto& entry = (*entries_)[i];
        if (entry.state.load(std::memory_order_acquire) != State::free) continue;
        entry.state.store(State::filling, std::memory_order_relaxed);  // only this side takes free entries
        if (++entry.generation == 0) entry.generation = 1;
        entry.order.store(order_++, std::memory_order_relaxed);
        entry.command = command;
        entry.address = address;
        entry.size = size;
        entry.gate_word.store(gate.word, std::memory_order_relaxed);
        entry.gate_bit.store(static_cast<std::uint8_t>(gate.bit), std::memory_order_relaxed);
        const auto* ahead = find(gate.behind);
        entry.gate_entry.store(gate.behind.entry, std::memory_order_relaxed);
        entry.gate_order.store(ahead != nullptr ? ahead->order.load(std::memory_order_relaxed) + 1 : 0, std::memory_order_relaxed);
        entry.wkc = 0;
        entry.passed = 0;
        const auto end = std::copy(data.begin(), data.end(), entry.data.begin());
        std::fill(end, entry.data.begin() + static_cast<std::ptrdiff_t>(size), std::byte{0});
        entry.state.store(State::submitted, std::memory_order_release);
        return EntryId{static_cast<std::uint8_t>(i), entry.generation};
    }
    return std::nullopt;
}

std::optional<EntryId> AcyclicChannel::submit(Command command, Address address, std::span<const std::byte> data) noexcept {
    return claim(command, address, data.size(), data, {});
}

std::optional<EntryId> AcyclicChannel::submit(Command command, Address address, std::size_t size) noexcept {
    return claim(command, address, size, {}, {});
}

std::optional<EntryId> AcyclicChannel::submit_gated(Command command, Address address, std::span<const std::byte> data,
                                                    const SendGate& gate) noexcept {
    return claim(command, address, data.size(), data, gate);
}

std::optional<EntryId> AcyclicChannel::submit_in_turn(EntryTurn& turn, Command command, Address address, std::span<const std::byte> data,
                                                      const SendGate& gate) noexcept {
    if (turn.channel_ == nullptr) {
        turn.channel_ = this;
        turn.gated_ = gate.exists();
        turn.ahead_ = last_in_line_;
        (last_in_line_ != nullptr ? last_in_line_->behind_ : first_in_line_) = &turn;
        last_in_line_ = &turn;
    }
    if (!turn_of(turn)) return std::nullopt;
    const auto id = claim(command, address, data.size(), data, gate);
    if (id) turn.leave();
    return id;
}

bool AcyclicChannel::turn_of(const EntryTurn& turn) const noexcept {
    std::size_t left = entry_count - in_use();
    if (left == 0) return false;
    std::size_t gates = turn.gated_ || first_in_line_ != &turn ? gated() : 0;
    for (const EntryTurn* other = first_in_line_; other != &turn && left > 0; other = other->behind_) {
        if (other->gated_ && gates >= max_gated) continue;  // waits for a gate, not for an entry
        gates += other->gated_ ? 1 : 0;
        --left;
    }
    return left > 0;
}

std::size_t AcyclicChannel::gated() const noexcept {
    return static_cast<std::size_t>(std::count_if(entries_->begin(), entries_->end(), [](const Entry& entry) {
        const bool has_gate =
            entry.gate_word.load(std::memory_order_relaxed) != nullptr || entry.gate_order.load(std::memory_order_relaxed) != 0;
        return has_gate && entry.state.load(std::memory_order_acquire) != State::free;
    }));
}

bool AcyclicChannel::withdraw(EntryId id) noexcept {
    auto* entry = find(id);
    auto seen = State::submitted;
    return entry != nullptr && entry->state.compare_exchange_strong(seen, State::free, std::memory_order_acq_rel);
}

bool AcyclicChannel::open(const Entry& entry) const noexcept {
    if (const auto* word = entry.gate_word.load(std::memory_order_relaxed); word != nullptr) {
        if ((word->load(std::memory_order_acquire) >> entry.gate_bit.load(std::memory_order_relaxed) & 1u) == 0) return false;
    }
    const std::uint64_t behind = entry.gate_order.load(std::memory_order_relaxed);
    if (behind == 0) return true;
    const auto& ahead = (*entries_)[entry.gate_entry.load(std::memory_order_relaxed)];
    if (ahead.order.load(std::memory_order_relaxed) + 1 != behind) return true;  // long gone
    return ahead.state.load(std::memory_order_acquire) != State::submitted && ahead.packed_in != packs_;
}

std::optional<AcyclicAnswer> AcyclicChannel::poll(EntryId id) const noexcept {
    const auto* entry = find(id);
    if (entry == nullptr) return AcyclicAnswer{.lost = true, .wkc = 0, .slaves_passed = 0, .data = {}, .sent_at = {}};
    switch (entry->state.load(std::memory_order_acquire)) {
        case State::done:
            return AcyclicAnswer{false, entry->wkc, entry->passed, std::span<const std::byte>{entry->data}.first(entry->size),
                                 entry->sent_at};
        case State::filling:
        case State::submitted:
        case State::in_flight: return std::nullopt;
        case State::lost:
        case State::free:
        case State::abandoned: break;
    }
    return AcyclicAnswer{.lost = true, .wkc = 0, .slaves_passed = 0, .data = {}, .sent_at = {}};
}

void AcyclicChannel::release(EntryId id) noexcept {
    auto* entry = find(id);
    if (entry == nullptr) return;
    // The cycle side moves submitted -> in_flight -> done/lost meanwhile; each exchange below meets one of these.
    auto seen = State::submitted;
    if (entry->state.compare_exchange_strong(seen, State::free, std::memory_order_acq_rel)) return;
    seen = State::in_flight;
    if (entry->state.compare_exchange_strong(seen, State::abandoned, std::memory_order_acq_rel)) return;
    if (seen == State::done || seen == State::lost) entry->state.store(State::free, std::memory_order_release);
}

std::size_t AcyclicChannel::in_use() const noexcept {
    return static_cast<std::size_t>(std::count_if(
        entries_->begin(), entries_->end(), [](const Entry& entry) { return entry.state.load(std::memory_order_acquire) != State::free; }));
}

void AcyclicChannel::finish(std::size_t number, State outcome) noexcept {
    auto& entry = (*entries_)[number];
    auto seen = State::in_flight;
    if (!entry.state.compare_exchange_strong(seen, outcome, std::memory_order_acq_rel))
        entry.state.store(State::free, std::memory_order_release);
}

std::size_t AcyclicChannel::pack(Instant now, std::size_t max_datagrams) noexcept {
    const auto flight = std::find_if(flights_->begin(), flights_->end(), [](const Flight& f) { return f.count == 0; });
    if (flight == flights_->end()) return 0;
    std::optional<SlotId> slot;
    ++packs_;
    const std::size_t limit = std::min(max_datagrams, max_datagrams_a_frame);
    while (flight->count < limit) {
        Entry* next = nullptr;
        std::uint64_t lowest = 0;
        for (auto& entry : *entries_) {
            if (entry.state.load(std::memory_order_acquire) != State::submitted || !open(entry)) continue;
            const auto order = entry.order.load(std::memory_order_relaxed);
            if (next == nullptr || order < lowest) next = &entry, lowest = order;
        }
        if (next == nullptr) break;
        if (!slot) slot = exchange_.begin(FrameKind::acyclic);
        if (!slot) break;
        auto seen = State::submitted;
        if (!next->state.compare_exchange_strong(seen, State::in_flight, std::memory_order_acq_rel)) continue;  // just released
        if (!exchange_.fits(*slot, next->size)) {  // the next frame's first: nothing overtakes a large request
            finish(static_cast<std::size_t>(next - entries_->data()), State::submitted);
            break;
        }
        next->packed_in = packs_;
        const auto datagram = exchange_.add(*slot, next->command, next->address, next->size);
        std::copy_n(next->data.begin(), next->size, datagram->data.begin());
        flight->entries[flight->count++] = static_cast<std::uint8_t>(next - entries_->data());
    }
    if (flight->count == 0) {
        if (slot) exchange_.release(*slot);
        return 0;
    }
    if (!exchange_.send(*slot, now)) {
        exchange_.release(*slot);
        for (std::size_t i = 0; i < flight->count; ++i) finish(flight->entries[i], State::lost);
        flight->count = 0;
        return 0;
    }
    flight->slot = *slot;
    flight->sent_at = now;
    return flight->count;
}

void AcyclicChannel::collect(Instant now) noexcept {
    for (auto& flight : *flights_) {
        if (flight.count == 0) continue;
        auto state = exchange_.state(flight.slot);
        if (state == SlotState::sent) {
            if (now - flight.sent_at < timeout_) continue;
            exchange_.expire(flight.slot);
            state = exchange_.state(flight.slot);
        }
        if (exchange_.half(flight.slot)) state = SlotState::lost;  // asked again: who did not answer may never have been asked
        for (std::size_t i = 0; i < flight.count; ++i) {
            auto& entry = (*entries_)[flight.entries[i]];
            if (state == SlotState::answered) {
                const auto data = exchange_.data(flight.slot, i);
                std::copy(data.begin(), data.end(), entry.data.begin());
                entry.wkc = exchange_.wkc(flight.slot, i);
                entry.passed = exchange_.slaves_passed(flight.slot, i);
                entry.sent_at = flight.sent_at;
            }
            finish(flight.entries[i], state == SlotState::answered ? State::done : State::lost);
        }
        exchange_.release(flight.slot);
        flight.count = 0;
    }
}

}  // namespace taktwerk::ecat
