#pragma once
// An object of a drive in the process image with the range that the drive takes: what is written never leaves the type nor the
// dictionary's minimum and maximum (SV33-E 6072h ends at 5000, its type at 65535). Real-time safe.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/process_image.hpp"

namespace taktwerk::axes::cia402 {

struct MappedOutput {
    Signal signal;
    std::int64_t low = 0, high = 0;

    /// Range of the type alone.
    void set_type_range() noexcept {
        if (signal.bits == 0 || signal.bits > 63) return;
        high = (std::int64_t{1} << (signal.bits - (signal.is_signed ? 1 : 0))) - 1;
        low = signal.is_signed ? -high - 1 : 0;
    }
    [[nodiscard]] bool mapped() const noexcept { return signal.mapped(); }

    /// Rounded and saturated; what is no number becomes 0 or the end nearest to it, never full speed backwards.
    [[nodiscard]] std::int64_t raw(double value) const noexcept {
        if (std::isnan(value)) return std::clamp<std::int64_t>(0, low, high);
        if (value <= static_cast<double>(low)) return low;
        if (value >= static_cast<double>(high)) return high;
        return std::clamp(static_cast<std::int64_t>(value < 0 ? value - 0.5 : value + 0.5), low, high);
    }
    void write(std::span<std::byte> image, double value) const noexcept {
        if (mapped()) write_signal(image, signal, raw(value));
    }
};

}  // namespace taktwerk::axes::cia402
