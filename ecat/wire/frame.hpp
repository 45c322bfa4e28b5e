#pragma once
// One Ethernet frame with EtherCAT datagrams: building and reading. Views over caller's bytes, no I/O, no allocation,
// real-time safe. Source: ETG.1000.4; sizes in ecat/wire/commands.hpp.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "ecat/wire/commands.hpp"

namespace taktwerk::ecat {

using MacAddress = std::array<std::uint8_t, 6>;
inline constexpr MacAddress broadcast_mac{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};

/// One datagram inside a frame. `data` and the working counter are views into it: valid as long as the frame is.
template <class Byte>
struct BasicDatagram {
    Command command{};
    std::uint8_t index = 0;
    Address address{};
    bool circulating = false;
    bool more_follow = false;
    std::uint16_t irq = 0;
    std::span<Byte> header;  ///< the 10 header bytes (a slave increments ADP in place)
    std::span<Byte> data;
    std::span<Byte> wkc;  ///< 2 bytes
    [[nodiscard]] std::uint16_t working_counter() const noexcept {
        return static_cast<std::uint16_t>(static_cast<unsigned>(wkc[0]) | (static_cast<unsigned>(wkc[1]) << 8));
    }
};
using Datagram = BasicDatagram<const std::byte>;
using MutableDatagram = BasicDatagram<std::byte>;

enum class FrameError : std::uint8_t {
    none,
    too_short,
    not_ethercat,
    wrong_type,
    length_beyond_frame,
    truncated_datagram,
    trailing_bytes,
    unknown_command,
};
[[nodiscard]] std::string_view text(FrameError error) noexcept;

/// Walks the datagrams of a received frame. Stops at the first defect; `error()` then says which.
class FrameReader {
public:
    explicit FrameReader(std::span<const std::byte> ethernet_frame) noexcept;
    [[nodiscard]] std::optional<Datagram> next() noexcept;
    [[nodiscard]] FrameError error() const noexcept { return error_; }

private:
    std::span<const std::byte> rest_;
    bool more_ = false;
    FrameError error_ = FrameError::none;
};

/// The same walk over a frame that may be changed in place: what a slave controller does.
class FrameEditor {
public:
    explicit FrameEditor(std::span<std::byte> ethernet_frame) noexcept;
    [[nodiscard]] std::optional<MutableDatagram> next() noexcept;
    [[nodiscard]] FrameError error() const noexcept { return error_; }

private:
    std::span<std::byte> rest_;
    bool more_ = false;
    FrameError error_ = FrameError::none;
};

/// Builds one frame in the caller's buffer (at least min_frame_size, at most max_frame_size bytes).
class FrameBuilder {
public:
    FrameBuilder(std::span<std::byte> buffer, const MacAddress& source, const MacAddress& destination = broadcast_mac) noexcept;

    /// Room for one more datagram with this much data?
    [[nodiscard]] bool fits(std::size_t data_size) const noexcept;
    /// Appends a datagram with zeroed data and working counter; returns its data to fill in (empty span when it does not
    /// fit or data_size is 0: check fits() first).
    std::span<std::byte> add(Command command, std::uint8_t index, Address address, std::size_t data_size) noexcept;
    [[nodiscard]] std::size_t datagrams() const noexcept { return count_; }
    /// Writes the EtherCAT header, pads to the minimum, returns the finished frame.
    [[nodiscard]] std::span<const std::byte> finish() noexcept;

private:
    std::span<std::byte> buffer_;
    std::size_t used_;
    std::size_t last_header_ = 0;
    std::size_t count_ = 0;
};

}  // namespace taktwerk::ecat
