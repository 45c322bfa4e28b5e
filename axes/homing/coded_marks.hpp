#pragma once
// Distance-coded reference marks: two neighbouring marks tell where on the scale they are. Real-time safe.
//
// Every `spacing` counts stands a fixed mark; between the fixed marks k and k + 1 stands one more, (spacing / 2 + (k + 1) * step) behind
// the fixed mark k. So every gap occurs once: wider than half the spacing, it begins at a fixed mark; narrower, it ends at one. Counts are
// the drive's, rising along the scale; mark 0 is the scale's zero. From the scale's data sheet: spacing = nominal increment in signal
// periods times counts per period, step = counts per period (1 mm and 20 um are usual).

#include <cstdint>
#include <optional>

#include "axes/homing/search.hpp"

namespace taktwerk::axes {

struct CodedMarks {
    std::int64_t spacing = 0;  ///< counts between two fixed marks; 0: the axis has no such scale
    std::int64_t step = 0;     ///< counts by which one gap differs from the next; spacing is an even multiple of it

    [[nodiscard]] constexpr bool valid() const noexcept { return step > 0 && spacing >= 4 * step && spacing % (2 * step) == 0; }

    /// Where on the scale [counts from its zero] the second of two marks passed one after the other is; nothing when no two neighbours of
    /// this scale are so far apart (within a quarter of a step): the marks are not those of this scale, or one was missed.
    [[nodiscard]] constexpr std::optional<std::int64_t> locate(std::int64_t first, std::int64_t second) const noexcept {
        const bool upwards = second > first;
        const std::int64_t gap = upwards ? second - first : first - second;
        const std::int64_t steps = (gap + step / 2) / step;
        const std::int64_t off = gap - steps * step;
        if ((off < 0 ? -off : off) * 4 > step || steps <= 0 || steps >= spacing / step) return std::nullopt;
        const std::int64_t code = steps - spacing / (2 * step);  // k + 1 from a fixed mark on, -(k + 1) up to one
        if (code == 0) return std::nullopt;
        const std::int64_t k = (code > 0 ? code : -code) - 1;
        const std::int64_t middle = k * spacing + spacing / 2 + (k + 1) * step;  // the mark between k and k + 1
        if (code > 0) return upwards ? middle : k * spacing;
        return upwards ? (k + 1) * spacing : middle;
    }
};

/// MC_StepDistanceCoded: over two marks, which the drive latches.
class CodedSearch {
public:
    CodedSearch() = default;
    CodedSearch(const CodedMarks& marks, bool positive) noexcept : marks_(marks), positive_(positive) {}

    [[nodiscard]] SearchMove step(const SearchInput& in) noexcept {
        if (in.latched && !seen_) {
            seen_ = true;
            first_ = in.latch;
        } else if (in.latched && in.latch != first_) {
            const auto at = marks_.locate(first_, in.latch);
            return at ? SearchMove::found(in.latch, *at) : SearchMove::failed();
        }
        if (positive_ ? in.positive_limit : in.negative_limit) return SearchMove::failed();
        return SearchMove::along(positive_ ? 1 : -1, true);
    }

private:
    CodedMarks marks_;
    bool positive_ = true, seen_ = false;
    std::int64_t first_ = 0;
};

}  // namespace taktwerk::axes
