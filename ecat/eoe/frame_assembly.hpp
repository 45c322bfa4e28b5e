#pragma once
// An Ethernet frame out of its pieces. What does not fit together is dropped as a whole and counted, as a switch drops a damaged frame: the
// protocols above ask again. No I/O, no allocation. Source: ETG.1000.6 (EoE).
//
//   the first piece          begins a frame, whatever was begun before
//   the next piece           same frame, next number, beginning where the last one ended; else the frame is dropped
//   a piece but the last     whole blocks of 32 bytes
//   the last piece           the frame is complete: no longer than the first piece said, and an Ethernet frame at all

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "ecat/wire/eoe.hpp"

namespace taktwerk::ecat {

class FrameAssembly {
public:
    /// The frame when this was its last piece; valid until the next call.
    [[nodiscard]] std::optional<std::span<const std::byte>> take(const EoeFragment& fragment) noexcept;

    [[nodiscard]] std::uint32_t dropped() const noexcept { return dropped_; }

private:
    void drop() noexcept;

    std::array<std::byte, 64 * eoe_block> bytes_{};
    std::size_t size_ = 0, announced_ = 0;
    std::uint8_t frame_ = 0, due_ = 0;  ///< due 0: none begun
    std::uint32_t dropped_ = 0;
};

}  // namespace taktwerk::ecat
