#pragma once
// Rows of signals that can be read, whoever has them: the memory of a running machine (signal_ring.hpp) or a recording that was kept.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/time.hpp"
#include "runtime/recording/recorded_signal.hpp"

namespace taktwerk::runtime {

class SignalRows {
public:
    virtual ~SignalRows() = default;

    [[nodiscard]] virtual const std::vector<RecordedSignal>& signals() const noexcept = 0;
    /// nullptr: there is none of this name.
    [[nodiscard]] const RecordedSignal* find(std::string_view name) const noexcept;
    /// Of a row.
    [[nodiscard]] virtual std::size_t words() const noexcept = 0;
    /// So many of the newest rows are kept.
    [[nodiscard]] virtual std::size_t depth() const noexcept = 0;
    /// From row to row.
    [[nodiscard]] virtual Duration cycle() const noexcept = 0;

    /// Cycles that can be read: [first, last]. Before the first row last < first.
    struct Span {
        std::uint64_t first = 1, last = 0;
        [[nodiscard]] bool empty() const noexcept { return last < first; }
    };
    [[nodiscard]] virtual Span span() const noexcept = 0;

    /// These words of the rows [from, to) to `out`, all of the first word, then all of the second: out[w * (to - from) + row].
    /// Returns the first cycle of which everything in `out` is right: `from`, or a later one when rows were overwritten meanwhile; `to`
    /// when none is left. [from, to) lies in a span() that was; each of `words` < words(). Never waits.
    [[nodiscard]] virtual std::uint64_t read(std::uint64_t from, std::uint64_t to, std::span<const std::uint16_t> words,
                                             std::span<std::uint64_t> out) const noexcept = 0;
};

/// The signal whose number in the row is the machine time in nanoseconds; there is one in each.
inline constexpr std::string_view time_signal = "time_s";

}  // namespace taktwerk::runtime
