#pragma once
// Packed blocks of a run in their order, in pieces of memory of one size. Each by itself, thousands of them that live for an hour would stand in the heap between
// what lives for a moment, and keep its holes open: a sixth of their size within an hour. And what the heap gets back it keeps; a piece goes back to the system.
//
// Not real-time; no thread of its own.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>

#include "runtime/recording_file/recording_file.hpp"

namespace taktwerk::runtime {

class BlockQueue {
public:
    [[nodiscard]] bool empty() const noexcept { return blocks_.empty(); }
    /// Of all blocks; what they stand in is at most a piece more at each end, and what does not fit behind another one.
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }

    void push(const PackedBlock& block);
    /// The oldest. Only where there is one.
    [[nodiscard]] PackedBlock pop();
    void clear() noexcept;

    static constexpr std::size_t piece = std::size_t{256} << 10;  ///< a longer block has one to itself

private:
    struct Block {
        std::size_t length = 0, records = 0;
        bool begins_piece = false;
    };
    /// Mapped by itself.
    class Piece {
    public:
        explicit Piece(std::size_t length);
        ~Piece();
        Piece(const Piece&) = delete;
        Piece& operator=(const Piece&) = delete;
        [[nodiscard]] std::size_t room() const noexcept { return length_ - used_; }
        void append(std::span<const std::byte> bytes) noexcept;
        [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return {at_, used_}; }

    private:
        std::byte* at_;
        std::size_t length_, used_ = 0;
    };
    std::deque<Block> blocks_;
    std::deque<Piece> pieces_;
    std::size_t read_ = 0;  // of the first piece
    std::uint64_t bytes_ = 0;
};

}  // namespace taktwerk::runtime
