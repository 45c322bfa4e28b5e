#pragma once
// What came from outside, byte by byte and in order, kept in memory while the cycle runs: the base of replay and of the
// flight recorder. Files are runtime/recording_file/'s business.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/time.hpp"

namespace taktwerk {

/// Which stream a record belongs to; its owner numbers them, the recording file carries their names.
using RecordChannel = std::uint16_t;

struct RecordView {
    RecordChannel channel = 0;
    Instant time;
    std::span<const std::byte> bytes;  ///< points into the recorder or recording it came from
};

/// A bounded ring of records for one writing thread. Storage is taken at construction.
///
/// drop_newest: what does not fit is lost and counted; one other thread may drain() at any time (for a complete recording).
/// overwrite_oldest: the last moments are always there (flight recorder); reading only while the writer rests.
class Recorder {
public:
    enum class Policy : std::uint8_t { drop_newest, overwrite_oldest };

    /// `capacity` in bytes, rounded up to 16; each record takes 16 bytes and its own bytes rounded up to 16, and may be at most
    /// half the capacity: a longer one is dropped.
    Recorder(std::size_t capacity, Policy policy);
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// Writer only; real-time safe. False: not recorded, counted in dropped().
    bool append(RecordChannel channel, Instant time, std::span<const std::byte> bytes) noexcept;

    /// Calls visit(RecordView) from the oldest to the newest and leaves them there. Only while nobody appends or drains.
    template <class Visit>
    void for_each(Visit&& visit) const {
        const std::uint64_t end = head_.load(std::memory_order_acquire);
        for (std::uint64_t at = tail_.load(std::memory_order_acquire); at != end;) visit(record_at(at));
    }

    /// Reader thread: calls visit(RecordView) for what is there now and frees it, record by record. The bytes are valid within the
    /// call only. With overwrite_oldest only while the writer rests.
    template <class Visit>
    void drain(Visit&& visit) {
        const std::uint64_t end = head_.load(std::memory_order_acquire);
        for (std::uint64_t at = tail_.load(std::memory_order_relaxed); at != end;) {
            visit(record_at(at));
            tail_.store(at, std::memory_order_release);
        }
    }

    /// Only while nobody appends or drains. Counters start again, too.
    void clear() noexcept;

    /// Any thread.
    [[nodiscard]] std::uint64_t recorded() const noexcept { return recorded_.load(std::memory_order_relaxed); }
    [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }
    [[nodiscard]] std::uint64_t overwritten() const noexcept { return overwritten_.load(std::memory_order_relaxed); }
    [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }

private:
    // Positions only grow; modulo capacity they are offsets. A record never wraps: what is left at the end is skipped by a filler.
    [[nodiscard]] RecordView record_at(std::uint64_t& at) const noexcept;
    [[nodiscard]] std::uint64_t end_of(std::uint64_t at) const noexcept;

    std::size_t capacity_;
    Policy policy_;
    std::unique_ptr<std::byte[]> storage_;
    alignas(64) std::atomic<std::uint64_t> head_{0};  // writer's
    std::atomic<std::uint64_t> recorded_{0}, dropped_{0}, overwritten_{0};
    alignas(64) std::atomic<std::uint64_t> tail_{0};  // reader's; the writer's with overwrite_oldest
};

}  // namespace taktwerk
