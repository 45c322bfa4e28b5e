#pragma once
// Some signals over a window of cycles, every sample of it: as they are, or as the smallest and the largest of each k cycles. In steps of
// bounded work, for threads that must not stall. Not the cycle's.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/recording/signal_rows.hpp"

namespace taktwerk::runtime {

class ThinnedRead {
public:
    struct Window {
        std::uint64_t from = 0, to = 0;  ///< cycles [from, to)
        std::uint64_t per = 1;           ///< 1: each value; more: a pair of each so many cycles, the last of fewer
    };
    /// `rows` and what `signals` point to outlive this. What of the window is not there (any more, or yet) is missing().
    ThinnedRead(const SignalRows& rows, std::vector<const RecordedSignal*> signals, Window window);

    /// At most about `cells` values are looked at; what is left of them comes back. True: all is done.
    bool step(std::size_t& cells);

    // --- once it is done -----------------------------------------------------------------------------------------------------------
    /// Where it begins: the first cycle of the window that was there.
    [[nodiscard]] std::uint64_t from() const noexcept { return from_; }
    [[nodiscard]] std::uint64_t to() const noexcept { return to_; }
    [[nodiscard]] std::uint64_t per() const noexcept { return per_; }
    /// Cycles of the window that were not there. Where some were overwritten behind the first values, those are NaN.
    [[nodiscard]] std::uint64_t missing() const noexcept { return missing_; }
    /// Of from(); 0 where nothing is.
    [[nodiscard]] Instant time() const noexcept { return time_; }
    /// One row of numbers for each signal: values, or smallest and largest in turn. A NaN counts only where there is nothing else.
    [[nodiscard]] const std::vector<std::vector<double>>& values() const noexcept { return values_; }

private:
    struct Extremes {
        double low = 0, high = 0;
        bool any = false;  ///< anything that is a number
    };
    void add(std::size_t signal, double value);
    void close_pairs();

    const SignalRows& rows_;
    std::vector<const RecordedSignal*> signals_;
    std::vector<std::uint16_t> words_;  // of the signals, then that of the time
    std::uint64_t from_, to_, per_, at_, missing_ = 0, in_pair_ = 0;
    Instant time_{};
    std::vector<std::uint64_t> buffer_;
    std::vector<Extremes> pairs_;
    std::vector<std::vector<double>> values_;
};

}  // namespace taktwerk::runtime
