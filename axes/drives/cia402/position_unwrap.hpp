#pragma once
// 6064h without its wraps, and the velocity that it tells where 606Ch is not mapped. Pure logic, real-time safe.

#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::axes::cia402 {

class PositionUnwrap {
public:
    /// a - b modulo 2^bits, sign-extended: a raw position may wrap between two samples.
    [[nodiscard]] static std::int64_t difference(std::int64_t a, std::int64_t b, unsigned bits) noexcept {
        const unsigned unused = 64u - bits;
        const auto wide = static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b);
        return static_cast<std::int64_t>(wide << unused) >> unused;
    }

    /// A position has been seen in OP before.
    [[nodiscard]] bool seeded() const noexcept { return seeded_; }
    /// Where `raw` lies, next to the last position that counted.
    [[nodiscard]] std::int64_t position(std::int64_t raw, unsigned bits) const noexcept {
        return seeded_ ? anchor_ + difference(raw, anchor_raw_, bits) : raw;
    }
    /// How far `raw` is from it.
    [[nodiscard]] std::int64_t beside(std::int64_t raw, unsigned bits) const noexcept { return difference(raw, anchor_raw_, bits); }
    void anchor(std::int64_t position, std::int64_t raw) noexcept {
        anchor_ = position;
        anchor_raw_ = raw;
        seeded_ = true;
    }

    /// When the position before was latched; nothing: there is none to compare with.
    [[nodiscard]] Instant before() const noexcept { return at_; }
    void counted(Instant at) noexcept { at_ = at; }
    /// The next position does not continue the one before.
    void interrupt() noexcept { at_ = {}; }

private:
    bool seeded_ = false;
    std::int64_t anchor_ = 0, anchor_raw_ = 0;  // unwrapped position and raw value of the last cycle that counted
    Instant at_{};
};

}  // namespace taktwerk::axes::cia402
