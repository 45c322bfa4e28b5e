#pragma once
// Mapped objects that nobody writes each cycle, at what the start-up list, the dictionary or the drive itself says: a zero there would override
// it (SE-808X 6081h, 6083h, 6084h; SV33-E 607Fh). Collected before the cycle, written in its first.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/process_image.hpp"

namespace taktwerk::axes::cia402 {

class StartingValues {
public:
    void clear() {
        values_.clear();
        written_ = false;
    }
    void add(const Signal& signal, std::int64_t value) { values_.emplace_back(signal, value); }
    /// 607Fh raw, 0 = unknown.
    void velocity_limit(std::int64_t raw) noexcept { velocity_limit_ = raw; }
    [[nodiscard]] std::int64_t velocity_limit() const noexcept { return velocity_limit_; }

    /// Real-time safe; does something once.
    void write_once(std::span<std::byte> image) noexcept {
        if (written_) return;
        written_ = true;
        for (const auto& [signal, value] : values_) write_signal(image, signal, value);
    }

private:
    std::vector<std::pair<Signal, std::int64_t>> values_;
    std::int64_t velocity_limit_ = 0;
    bool written_ = false;
};

}  // namespace taktwerk::axes::cia402
