#pragma once
// The memory of the scope: every cycle as one row of 64-bit words, the newest rows in one preallocated ring. The cycle writes each row
// once; traces, scope and alarm recordings read the same rows from other threads, and find out by themselves what has been overwritten
// meanwhile. Nobody ever waits for a reader.
//
//   cycle           auto row = ring.begin(cycle); row.put(...); ...; ring.commit();
//   anybody else    ring.read(from, to, words, out)
//
// Words are stored with release and read with acquire (on x86 the same instructions as plain ones): whoever has read a word of a newer
// row than it wanted also sees that this row was begun. H.-J. Boehm, "Can seqlocks get along with programming language memory models?", 2012.

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "runtime/recording/recorded_signal.hpp"
#include "runtime/recording/signal_rows.hpp"

namespace taktwerk::runtime {

class SignalRing final : public SignalRows {
public:
    /// `words` in a row, > 0; `depth` rows, > 0, can be read at any time, whatever is being written. `cycle`: from row to row. Takes all
    /// memory here; throws std::bad_alloc where there is none.
    SignalRing(std::vector<RecordedSignal> signals, std::size_t words, std::size_t depth, Duration cycle);
    SignalRing(const SignalRing&) = delete;
    SignalRing& operator=(const SignalRing&) = delete;

    [[nodiscard]] const std::vector<RecordedSignal>& signals() const noexcept override { return signals_; }
    [[nodiscard]] std::size_t words() const noexcept override { return words_; }
    [[nodiscard]] std::size_t depth() const noexcept override { return rows_ - 1; }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_for(words_, depth()); }
    [[nodiscard]] Duration cycle() const noexcept override { return cycle_; }
    [[nodiscard]] static constexpr std::size_t bytes_for(std::size_t words, std::size_t depth) noexcept {
        return words * (depth + 1) * sizeof(std::uint64_t);
    }
    /// Before the first row, not real-time: every page of the memory is there, and no row waits for one.
    void touch() noexcept;

    // --- cycle thread: real-time safe ------------------------------------------------------------------------------------------
    /// The words of one row, one after the other.
    class Row {
    public:
        explicit Row(std::uint64_t* at) noexcept : at_(at) {}
        void put(std::uint64_t word) noexcept { std::atomic_ref<std::uint64_t>(*at_++).store(word, std::memory_order_release); }
        void put(double value) noexcept { put(std::bit_cast<std::uint64_t>(value)); }
        void put(Duration time) noexcept { put(static_cast<std::uint64_t>(time.count())); }

    private:
        std::uint64_t* at_;
    };
    /// The row of this cycle; exactly words() words are put, then commit(). Cycles count up by one; the first is 1 or more.
    [[nodiscard]] Row begin(std::uint64_t cycle) noexcept {
        if (slot_ == rows_) slot_ = 0;
        if (first_.load(std::memory_order_relaxed) == 0) first_.store(cycle, std::memory_order_relaxed);
        begun_.store(cycle, std::memory_order_relaxed);
        return Row{data_.get() + words_ * slot_++};
    }
    void commit() noexcept { newest_.store(begun_.load(std::memory_order_relaxed), std::memory_order_release); }

    // --- any thread --------------------------------------------------------------------------------------------------------------
    [[nodiscard]] Span span() const noexcept override;
    [[nodiscard]] std::uint64_t read(std::uint64_t from, std::uint64_t to, std::span<const std::uint16_t> words,
                                     std::span<std::uint64_t> out) const noexcept override;
    /// A whole row; false: it is not there (any more). `out`: words().
    [[nodiscard]] bool read_row(std::uint64_t cycle, std::span<std::uint64_t> out) const noexcept;

    /// A reader that every row must reach (a trace) has missed some: counted, for the machine's statistics.
    void tell_lost(std::uint64_t rows) noexcept { lost_.fetch_add(rows, std::memory_order_relaxed); }
    [[nodiscard]] std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

private:
    struct Free {
        void operator()(void* memory) const noexcept { std::free(memory); }
    };
    [[nodiscard]] std::uint64_t load(std::uint64_t cycle, std::size_t word) const noexcept {
        return std::atomic_ref<std::uint64_t>(data_[(cycle - first_.load(std::memory_order_relaxed)) % rows_ * words_ + word])
            .load(std::memory_order_acquire);
    }

    std::vector<RecordedSignal> signals_;
    std::size_t words_, rows_;
    Duration cycle_;
    std::unique_ptr<std::uint64_t[], Free> data_;  // calloc: pages of a machine that never runs are never touched
    std::size_t slot_ = 0;                         // the cycle's
    alignas(64) std::atomic<std::uint64_t> newest_{0};
    std::atomic<std::uint64_t> begun_{0}, first_{0};
    std::atomic<std::uint64_t> lost_{0};
};

}  // namespace taktwerk::runtime
