#pragma once
// What a block's ErrorID means, why it comes and what to do, by its number. The words: error_texts.hpp. Axis errors (0x3xxx) are in
// alarms.hpp.

#include "axes/axis/error_texts.hpp"

namespace taktwerk::axes {

namespace error_check {
constexpr bool whole(const ErrorWords& words) { return !words.text.empty() && !words.cause.empty() && !words.remedy.empty(); }

/// Entry i belongs to id i, nothing is left empty, and no name stands twice.
consteval bool sound() {
    for (std::size_t i = 0; i < error_texts.size(); ++i) {
        const auto& error = error_texts[i];
        if (static_cast<std::size_t>(error.id) != i) return false;
        if (error.name.empty() || !whole(error.english) || !whole(error.chinese)) return false;
        for (std::size_t before = 0; before < i; ++before)
            if (error_texts[before].name == error.name) return false;
    }
    return true;
}
static_assert(sound());
}  // namespace error_check

/// nullptr for axis errors (see alarms.hpp) and unknown numbers.
[[nodiscard]] constexpr const ErrorText* find_error(ErrorId id) noexcept {
    const auto i = static_cast<std::size_t>(id);
    return i < error_texts.size() ? &error_texts[i] : nullptr;
}

}  // namespace taktwerk::axes
