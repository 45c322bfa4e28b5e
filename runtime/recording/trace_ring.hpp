#pragma once
// Every cycle as one row of numbers, for traces: written by the cycle, read by one other thread. Fixed rows, wait-free;
// a row that does not fit is dropped and counted.

#include <atomic>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace taktwerk::runtime {

class TraceRing {
public:
    /// `rows` is rounded up to a power of two. Allocates here.
    TraceRing(std::vector<std::string> columns, std::size_t rows) : columns_(std::move(columns)) {
        std::size_t capacity = 1;
        while (capacity < rows) capacity *= 2;
        mask_ = capacity - 1;
        data_.resize(capacity * columns_.size());
    }
    [[nodiscard]] const std::vector<std::string>& columns() const noexcept { return columns_; }

    /// Cycle thread: the next row to fill, empty when the reader is too far behind. Then commit().
    [[nodiscard]] std::span<double> begin() noexcept {
        const auto head = head_.load(std::memory_order_relaxed);
        if (head - tail_.load(std::memory_order_acquire) > mask_) {
            dropped_.fetch_add(1, std::memory_order_relaxed);
            return {};
        }
        return {data_.data() + (head & mask_) * columns_.size(), columns_.size()};
    }
    void commit() noexcept { head_.store(head_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

    /// Reader: the oldest row, empty when there is none. Then release().
    [[nodiscard]] std::span<const double> front() const noexcept {
        const auto tail = tail_.load(std::memory_order_relaxed);
        if (tail == head_.load(std::memory_order_acquire)) return {};
        return {data_.data() + (tail & mask_) * columns_.size(), columns_.size()};
    }
    void release() noexcept { tail_.store(tail_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }
    [[nodiscard]] std::size_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

private:
    std::vector<std::string> columns_;
    std::vector<double> data_;
    std::size_t mask_ = 0;
    alignas(64) std::atomic<std::size_t> head_{0};
    alignas(64) std::atomic<std::size_t> tail_{0};
    std::atomic<std::size_t> dropped_{0};
};

}  // namespace taktwerk::runtime
