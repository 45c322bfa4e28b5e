#pragma once
// Rows that were kept: a recording in memory, read like a running machine (signal_rows.hpp). Constant.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "runtime/recording/signal_rows.hpp"
#include "runtime/scope_file/scope_head.hpp"

namespace taktwerk::runtime {

class KeptRows final : public SignalRows {
public:
    /// `columns`: all rows of the first word, then of the second; head.words of them.
    KeptRows(ScopeHead head, std::vector<std::uint64_t> columns)
        : head_(std::move(head)), columns_(std::move(columns)), rows_(columns_.size() / head_.words) {}

    [[nodiscard]] const ScopeHead& head() const noexcept { return head_; }
    [[nodiscard]] const std::vector<RecordedSignal>& signals() const noexcept override { return head_.signals; }
    [[nodiscard]] std::size_t words() const noexcept override { return head_.words; }
    [[nodiscard]] std::size_t depth() const noexcept override { return rows_; }
    [[nodiscard]] Duration cycle() const noexcept override { return head_.cycle; }
    [[nodiscard]] Span span() const noexcept override { return {head_.first_cycle, head_.first_cycle + rows_ - 1}; }
    [[nodiscard]] std::uint64_t read(std::uint64_t from, std::uint64_t to, std::span<const std::uint16_t> words,
                                     std::span<std::uint64_t> out) const noexcept override {
        const auto count = to - from;
        for (std::size_t w = 0; w < words.size(); ++w)
            for (std::uint64_t row = 0; row < count; ++row)
                out[w * count + row] = columns_[words[w] * rows_ + (from - head_.first_cycle) + row];
        return from;
    }
    /// One value.
    [[nodiscard]] double value(const RecordedSignal& signal, std::uint64_t cycle) const noexcept {
        return signal.cell.value_of(columns_[signal.cell.word * rows_ + (cycle - head_.first_cycle)]);
    }

private:
    ScopeHead head_;
    std::vector<std::uint64_t> columns_;
    std::size_t rows_;
};

}  // namespace taktwerk::runtime
