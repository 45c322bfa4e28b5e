#include "core/recorder.hpp"

#include <algorithm>
#include <cstring>

#include "core/bytes.hpp"

namespace taktwerk {
namespace {

// A frame: length u32, channel u16, kind u16, time i64, then the bytes. Everything starts at multiples of 16, so that a
// frame's head always fits before the end of the storage.
constexpr std::size_t grain = 16;
constexpr std::uint16_t kind_record = 0;
constexpr std::uint16_t kind_filler = 1;  // unused up to the end of the storage

constexpr std::size_t rounded(std::size_t bytes) noexcept { return (bytes + grain - 1) / grain * grain; }

void bump(std::atomic<std::uint64_t>& counter) noexcept {
    counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);  // one writing thread
}

}  // namespace

Recorder::Recorder(std::size_t capacity, Policy policy)
    : capacity_(rounded(std::max(capacity, grain))), policy_(policy), storage_(std::make_unique<std::byte[]>(capacity_)) {}

/// Past the frame at `at`, filler or record.
std::uint64_t Recorder::end_of(std::uint64_t at) const noexcept {
    const std::span<const std::byte> frame{storage_.get() + at % capacity_, grain};
    return at + grain + rounded(load_le<std::uint32_t>(frame));
}

RecordView Recorder::record_at(std::uint64_t& at) const noexcept {
    const auto kind_at = [&] { return load_le<std::uint16_t>(std::span<const std::byte>{storage_.get() + at % capacity_, grain}, 6); };
    if (kind_at() == kind_filler) at = end_of(at);  // a filler is always followed by a record
    const std::byte* begin = storage_.get() + at % capacity_;
    const std::span<const std::byte> head{begin, grain};
    RecordView view{load_le<std::uint16_t>(head, 4), Instant{Duration{load_le<std::int64_t>(head, 8)}},
                    std::span<const std::byte>{begin + grain, load_le<std::uint32_t>(head)}};
    at = end_of(at);
    return view;
}

bool Recorder::append(RecordChannel channel, Instant time, std::span<const std::byte> bytes) noexcept {
    const std::size_t needed = grain + rounded(bytes.size());
    if (bytes.size() > capacity_ || needed > capacity_ / 2) return bump(dropped_), false;
    std::uint64_t head = head_.load(std::memory_order_relaxed);
    const std::size_t to_end = capacity_ - static_cast<std::size_t>(head % capacity_);
    const std::size_t filler = needed > to_end ? to_end : 0;  // below `needed`, so both together always fit an empty ring

    std::uint64_t tail = tail_.load(std::memory_order_acquire);
    while (head + filler + needed - tail > capacity_) {
        if (policy_ == Policy::drop_newest) return bump(dropped_), false;
        (void)record_at(tail);  // moves past the oldest
        tail_.store(tail, std::memory_order_release);
        bump(overwritten_);
    }

    const auto put_head = [&](std::size_t length, std::uint16_t kind) {
        const std::span<std::byte> frame{storage_.get() + head % capacity_, grain};
        store_le(frame, 0, static_cast<std::uint32_t>(length));
        store_le(frame, 4, channel);
        store_le(frame, 6, kind);
        store_le(frame, 8, time.time_since_epoch().count());
    };
    if (filler > 0) {
        put_head(filler - grain, kind_filler);
        head += filler;
    }
    put_head(bytes.size(), kind_record);
    if (!bytes.empty()) std::memcpy(storage_.get() + head % capacity_ + grain, bytes.data(), bytes.size());
    head_.store(head + needed, std::memory_order_release);
    bump(recorded_);
    return true;
}

void Recorder::clear() noexcept {
    head_ = tail_ = 0;
    recorded_ = dropped_ = overwritten_ = 0;
}

}  // namespace taktwerk
