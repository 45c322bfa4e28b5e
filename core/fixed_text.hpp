#pragma once
// A short text of bounded length that can live in a snapshot or a ring: trivially copyable, no allocation.

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace taktwerk {

template <std::size_t Capacity>
struct FixedText {
    std::array<char, Capacity> bytes{};
    std::size_t length = 0;

    constexpr FixedText() = default;
    /// Longer texts are cut.
    constexpr FixedText(std::string_view text) noexcept : length(std::min(text.size(), Capacity)) {  // NOLINT
        std::copy_n(text.begin(), length, bytes.begin());
    }
    [[nodiscard]] constexpr std::string_view view() const noexcept { return {bytes.data(), length}; }
    friend constexpr bool operator==(const FixedText& a, const FixedText& b) noexcept { return a.view() == b.view(); }
};

}  // namespace taktwerk
