#include "runtime/run_memory/block_queue.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <new>

namespace taktwerk::runtime {

BlockQueue::Piece::Piece(std::size_t length) : length_(length) {
    auto* const at = ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (at == MAP_FAILED) throw std::bad_alloc{};
    at_ = static_cast<std::byte*>(at);
}
BlockQueue::Piece::~Piece() { ::munmap(at_, length_); }
void BlockQueue::Piece::append(std::span<const std::byte> bytes) noexcept {
    std::copy(bytes.begin(), bytes.end(), at_ + used_);
    used_ += bytes.size();
}

void BlockQueue::push(const PackedBlock& block) {
    const auto length = block.bytes.size();
    const bool begins = pieces_.empty() || pieces_.back().room() < length;
    if (begins) pieces_.emplace_back(std::max(piece, length));
    pieces_.back().append(block.bytes);
    blocks_.push_back({length, block.records, begins});
    bytes_ += length;
}

PackedBlock BlockQueue::pop() {
    const auto first = blocks_.front();
    blocks_.pop_front();
    const auto bytes = pieces_.front().bytes().subspan(read_, first.length);
    PackedBlock block{{bytes.begin(), bytes.end()}, first.records};
    read_ += first.length;
    bytes_ -= first.length;
    if (blocks_.empty() || blocks_.front().begins_piece) {
        pieces_.pop_front();
        read_ = 0;
    }
    return block;
}

void BlockQueue::clear() noexcept {
    blocks_.clear();
    pieces_.clear();
    read_ = 0;
    bytes_ = 0;
}

}  // namespace taktwerk::runtime
