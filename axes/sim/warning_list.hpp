#pragma once
// The warnings of a drive that stand at once: each goes with its cause, the latest is the one shown (SV33-E manual 5.3).

#include <algorithm>
#include <array>
#include <cstddef>

#include "axes/sim/drive_alarm_codes.hpp"

namespace taktwerk::axes::sim {

class WarningList {
public:
    static constexpr std::size_t capacity = 16;

    /// True when it was not there before. One that no longer fits is left out.
    bool set(const AlarmCode& warning) noexcept {
        if (find(warning) != end() || size_ == capacity) return false;
        list_[size_++] = warning;
        return true;
    }
    void clear(const AlarmCode& warning) noexcept {
        const auto at = find(warning);
        if (at == end()) return;
        std::copy(at + 1, end(), at);
        --size_;
    }
    void clear() noexcept { size_ = 0; }
    [[nodiscard]] bool any() const noexcept { return size_ > 0; }
    /// Only while any() holds.
    [[nodiscard]] const AlarmCode& shown() const noexcept { return list_[size_ - 1]; }

private:
    using Position = std::array<AlarmCode, capacity>::iterator;
    [[nodiscard]] Position end() noexcept { return list_.begin() + static_cast<std::ptrdiff_t>(size_); }
    [[nodiscard]] Position find(const AlarmCode& warning) noexcept {
        return std::find_if(list_.begin(), end(), [&](const AlarmCode& w) { return w.code == warning.code && w.detail == warning.detail; });
    }

    std::array<AlarmCode, capacity> list_{};
    std::size_t size_ = 0;
};

}  // namespace taktwerk::axes::sim
