#pragma once
// Two copies of one frame, each processed by some slaves, become what one would be that all of them had processed. Pure, real-time safe.
//
// Datagram by datagram, against what was sent: working counters and increments of ADP add up, event bits are ORed, and of the data what
// slaves changed is taken from the copy in which they changed it. Slaves of the two halves never change the same bit but in a broadcast,
// which ORs; so
//     data = sent ^ ((first ^ sent) | (second ^ sent second))
// is right for reads, writes, logical commands and broadcasts alike. Source: ETG.1000.4 (what each command does to data and counter).

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "ecat/wire/frame_fields.hpp"

namespace taktwerk::ecat {

/// One copy, as it left and as it came back: whole frames.
struct FrameCopy {
    std::span<const std::byte> sent, came;
};

/// `came` is `sent` with nothing changed but what slaves change: commands, indices, lengths, addresses, number of datagrams.
[[nodiscard]] bool same_datagrams(const FrameCopy& copy) noexcept;

/// Writes what slaves did to either copy into `out`, which holds what `first` sent. Both have passed same_datagrams(); a copy that is
/// missing counts as one that came back as it left.
void merge(const FrameCopy& first, const FrameCopy& second, std::span<std::byte> out) noexcept;

/// How many slaves the copy passed, by its first datagram that counts them (auto-increment and broadcast commands).
[[nodiscard]] std::optional<std::uint16_t> slaves_passed(const FrameCopy& copy) noexcept;

/// Offsets of the datagrams of a sound frame, one after the other.
class DatagramWalk {
public:
    explicit DatagramWalk(std::span<const std::byte> frame) noexcept : frame_(frame) {}
    /// Offset of the next datagram's header; nothing behind the last.
    [[nodiscard]] std::optional<std::size_t> next() noexcept;
    /// Bytes of data of the datagram that next() gave last.
    [[nodiscard]] std::size_t size() const noexcept { return size_; }

private:
    std::span<const std::byte> frame_;
    std::size_t at_ = 0, size_ = 0;
    bool more_ = true;
};

}  // namespace taktwerk::ecat
