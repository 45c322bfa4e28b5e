#include "runtime/recording/signal_ring.hpp"

#include <algorithm>
#include <new>
#include <string_view>
#include <utility>

namespace taktwerk::runtime {

SignalRing::SignalRing(std::vector<RecordedSignal> signals, std::size_t words, std::size_t depth, Duration cycle)
    : signals_(std::move(signals)),
      words_(words),
      rows_(depth + 1),
      cycle_(cycle),
      data_(static_cast<std::uint64_t*>(std::calloc(words * (depth + 1), sizeof(std::uint64_t)))) {
    if (!data_) throw std::bad_alloc{};
}

const RecordedSignal* SignalRows::find(std::string_view name) const noexcept {
    const auto& all = signals();
    const auto found = std::find_if(all.begin(), all.end(), [&](const RecordedSignal& s) { return s.name == name; });
    return found == all.end() ? nullptr : &*found;
}

void SignalRing::touch() noexcept {
    constexpr std::size_t page = 4096 / sizeof(std::uint64_t);
    for (std::size_t i = 0; i < words_ * rows_; i += page) std::atomic_ref<std::uint64_t>(data_[i]).store(0, std::memory_order_relaxed);
}

SignalRows::Span SignalRing::span() const noexcept {
    const auto last = newest_.load(std::memory_order_acquire);
    const auto first = first_.load(std::memory_order_relaxed);
    if (last == 0) return {};
    return {std::max(first, last + 1 > depth() ? last + 1 - depth() : first), last};
}

std::uint64_t SignalRing::read(std::uint64_t from, std::uint64_t to, std::span<const std::uint16_t> words,
                               std::span<std::uint64_t> out) const noexcept {
    const std::size_t count = to - from;
    auto slot = (from - first_.load(std::memory_order_relaxed)) % rows_;
    for (std::size_t row = 0; row < count; ++row) {
        std::uint64_t* const at = data_.get() + slot * words_;
        for (std::size_t w = 0; w < words.size(); ++w)
            out[w * count + row] = std::atomic_ref<std::uint64_t>(at[words[w]]).load(std::memory_order_acquire);
        if (++slot == rows_) slot = 0;
    }
    // The row being written now has taken the place of the one that is rows_ older.
    const auto begun = begun_.load(std::memory_order_relaxed);
    return std::clamp(begun >= rows_ ? begun - rows_ + 1 : 0, from, to);
}

bool SignalRing::read_row(std::uint64_t cycle, std::span<std::uint64_t> out) const noexcept {
    const auto there = span();
    if (cycle < there.first || cycle > there.last) return false;
    for (std::size_t w = 0; w < words_; ++w) out[w] = load(cycle, w);
    const auto begun = begun_.load(std::memory_order_relaxed);
    return cycle + rows_ > begun;
}

}  // namespace taktwerk::runtime
